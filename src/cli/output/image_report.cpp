// The report of one conversion, as text and as JSON.
#include "src/cli/output/image_report.hpp"

#include <fmt/format.h>

#include "src/cli/output/messages.hpp"
#include "src/cli/output/print.hpp"

namespace spectile::cli {
namespace {

const char* done_to_negative(NegativeInput negative) {
  switch (negative) {
    case NegativeInput::kClip:
      return "clipped to 0; --negative gamut or keep changes that";
    case NegativeInput::kKeep:
      return "kept as they are; --negative gamut or clip changes that";
    default:
      return "treated as colours out of gamut; --negative clip or keep changes that";
  }
}

void print_skipped(const SkipStats& s) {
  print("  skipped: {} masked, {} black, {} in blocks of one colour\n", plural(s.masked_pixels, "pixel"),
        s.black_pixels, s.constant_pixels);
  print("  {} of {} reused\n", s.chunks_reused, plural(s.chunks, "chunk"));
  if (s.colors_looked_up > 0) {
    print("  {} looked up, {} of them solved\n", plural(s.colors_looked_up, "colour"), s.colors_solved);
  }
  print("  about {:.2f} s of one core saved\n", s.core_seconds_saved);
}

void print_colors(const ImageReport& r, const ColorHandling& colors) {
  if (r.negative_pixels > 0) {
    print("  {} with a component below 0, {}\n", plural(r.negative_pixels, "pixel"),
          done_to_negative(colors.negative));
  }
  if (r.over_one_pixels > 0 && r.quantity == Quantity::kReflectance) {
    print("  {} above 1, which no real reflectance is: {}\n", plural(r.over_one_pixels, "pixel"),
          colors.clips_above_one
              ? "clipped to the method's gamut (--out-of-gamut); --quantity unbounded keeps them"
              : "kept, so that spectra exceed 1; --quantity unbounded says that they may");
  }
  if (r.out_of_gamut_pixels > 0) {
    print("  {} outside the method's gamut, {}\n", plural(r.out_of_gamut_pixels, "pixel"),
          colors.out_of_gamut == GamutPolicy::kKeep
              ? "kept as they are; --out-of-gamut clip moves them into it"
              : "clipped towards the grey of their luminance; --out-of-gamut keep or error changes that");
  }
}

}  // namespace

nlohmann::json report_json(const std::string& input, const std::string& output, const ImageReport& r) {
  return {{"input", input},
          {"output", output},
          {"width", r.width},
          {"height", r.height},
          {"bands", r.bands},
          {"quantity", to_string(r.quantity)},
          {"color_space", r.color_space},
          {"nonfinite_pixels", r.nonfinite_pixels},
          {"negative_pixels", r.negative_pixels},
          {"over_one_pixels", r.over_one_pixels},
          {"out_of_gamut_pixels", r.out_of_gamut_pixels},
          {"clamped_pixels", r.clamped_pixels},
          {"bytes_written", r.bytes_written},
          {"seconds", r.seconds},
          {"skipped",
           {{"masked_pixels", r.skipped.masked_pixels},
            {"black_pixels", r.skipped.black_pixels},
            {"constant_pixels", r.skipped.constant_pixels},
            {"chunks", r.skipped.chunks},
            {"chunks_reused", r.skipped.chunks_reused},
            {"colors_looked_up", r.skipped.colors_looked_up},
            {"colors_solved", r.skipped.colors_solved},
            {"core_seconds_saved", r.skipped.core_seconds_saved}}},
          {"mpixel_per_s", static_cast<double>(r.pixels()) / r.seconds * 1e-6},
          {"notes", r.notes}};
}

void print_report(const std::string& input, const std::string& output, const ImageReport& r,
                  const std::optional<ColorHandling>& colors, Notes& notes, bool stats) {
  print("{} -> {}: {} x {}, {}, {}, {}, {:.2f} s\n", input, output, r.width, r.height,
        plural(r.bands, "band"), size_text(r.bytes_written), speed_text(r.pixels(), r.seconds), r.seconds);
  if (!r.color_space.empty()) print("  input space: {}\n", r.color_space);
  if (r.nonfinite_pixels > 0) print("  {} made black\n", plural(r.nonfinite_pixels, "non-finite pixel"));
  if (colors) print_colors(r, *colors);
  print_clamped(r.clamped_pixels, "pixel");
  notes.print(r.notes);
  if (stats) print_skipped(r.skipped);
}

}  // namespace spectile::cli
