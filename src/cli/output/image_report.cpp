// The report of one conversion, as text and as JSON.
#include "src/cli/output/image_report.hpp"

#include <fmt/format.h>

#include "src/cli/output/messages.hpp"

namespace spectile::cli {
namespace {

void print_skipped(const SkipStats& s) {
  fmt::print("  skipped: {} masked, {} black, {} in blocks of one colour\n", plural(s.masked_pixels, "pixel"),
             s.black_pixels, s.constant_pixels);
  fmt::print("  {} of {} reused\n", s.chunks_reused, plural(s.chunks, "chunk"));
  if (s.colors_looked_up > 0) {
    fmt::print("  {} looked up, {} of them solved\n", plural(s.colors_looked_up, "colour"), s.colors_solved);
  }
  fmt::print("  about {:.2f} s of one core saved\n", s.core_seconds_saved);
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

void print_report(const std::string& input, const std::string& output, const ImageReport& r, bool stats) {
  fmt::print("{} -> {}: {} x {}, {}, {}, {}, {:.2f} s\n", input, output, r.width, r.height,
             plural(r.bands, "band"), size_text(r.bytes_written), speed_text(r.pixels(), r.seconds),
             r.seconds);
  if (!r.color_space.empty()) fmt::print("  input space: {}\n", r.color_space);
  if (r.nonfinite_pixels > 0) fmt::print("  {} made black\n", plural(r.nonfinite_pixels, "non-finite pixel"));
  if (r.negative_pixels > 0) {
    fmt::print("  {} with a component below 0\n", plural(r.negative_pixels, "pixel"));
  }
  if (r.over_one_pixels > 0 && r.quantity == Quantity::kReflectance && !r.color_space.empty()) {
    fmt::print("  {} above 1, which no real reflectance is\n", plural(r.over_one_pixels, "pixel"));
  }
  if (r.out_of_gamut_pixels > 0) {
    fmt::print("  {} outside the method's gamut\n", plural(r.out_of_gamut_pixels, "pixel"));
  }
  print_clamped(r.clamped_pixels, "pixel");
  for (const std::string& note : r.notes) fmt::print("  {}\n", note);
  if (stats) print_skipped(r.skipped);
}

}  // namespace spectile::cli
