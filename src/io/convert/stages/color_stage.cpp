// ColorStage: from an image's samples to the RGB of a method, with every check on the way.
#include "src/io/convert/stages/color_stage.hpp"

#include <fmt/format.h>

#include "src/color/color_matrix.hpp"
#include "src/io/convert/sources/color_space.hpp"
#include "src/upsampling/grid/color_grid.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile::io {

ColorStage::ColorStage(const RgbSource& source, const Upsampler& upsampler, const MethodOptions& options,
                       const kernels::KernelTable& kernels)
    : source_(source),
      upsampler_(upsampler),
      options_(options),
      kernels_(kernels),
      space_(options.input_space ? *options.input_space : source.color_space()),
      out_of_gamut_(options.out_of_gamut.value_or(
          options.negative == NegativeInput::kKeep ? GamutPolicy::kKeep : GamutPolicy::kClip)) {
  convert_ = !is_srgb(space_);
  matrix_ = color::to_float(to_srgb(space_, options.quantity));
}

float ColorStage::line(const Strip& strip, int line, const ColorLine& color, LineStats& stats) const {
  const auto width = static_cast<std::size_t>(strip.width);
  load(strip, line, color);
  const Sanitized sanitized = sanitize(line, color, width, stats);
  if (sanitized.may_be_outside) clip_to_gamut(line, color, width, stats);
  return sanitized.largest;
}

void ColorStage::load(const Strip& strip, int line, const ColorLine& color) const {
  source_.float_rows(kernels_, strip, line, color.rows);
}

ColorStage::Sanitized ColorStage::sanitize(int line, const ColorLine& color, std::size_t width,
                                           LineStats& stats) const {
  float* const* rows = color.rows;
  const float* const rgb[3] = {rows[0], rows[1], rows[2]};
  sanitize_nonfinite(kernels_, rows, width, line, options_.nonfinite, stats);
  LineStats own;
  float largest = sanitize_range(kernels_, rows, width, line, options_.negative, own);
  stats.negative.add(own.negative);
  if (convert_) {
    kernels_.transform3(rows, rgb, matrix_.data(), color.padded);
    own = {};
    largest = sanitize_range(kernels_, rows, width, line, NegativeInput::kKeep, own);
  }
  stats.over_one += own.over_one;
  // Most lines have no colour that any method could not make.
  const bool bounded = !rows::stores_rgb(upsampler_) && options_.quantity == Quantity::kReflectance;
  return {largest,
          own.negative.count > 0 || (bounded && own.over_one > 0) || !rows::covers_unit_cube(upsampler_)};
}

void ColorStage::clip_to_gamut(int line, const ColorLine& color, std::size_t width, LineStats& stats) const {
  const GamutReport found = rows::gamut_clip(kernels_, upsampler_, color.rows, out_of_gamut_, width);
  if (found.outside > 0) stats.outside.add(found.outside, static_cast<int>(found.first), line);
}

std::optional<Error> ColorStage::refusal(const std::string& path, const LineStats& stats) const {
  if (options_.nonfinite == NonFinite::kStop && stats.nonfinite.count > 0) {
    return stopped_at(path, ErrorCode::kNonFinite, "non-finite", stats.nonfinite.moved(source_.offset()),
                      "--nonfinite zero makes them black");
  }
  if (options_.negative == NegativeInput::kError && stats.negative.count > 0) {
    return stopped_at(path, ErrorCode::kBadFile, "negative", stats.negative.moved(source_.offset()),
                      "--negative clip or keep converts them");
  }
  if (out_of_gamut_ == GamutPolicy::kError && stats.outside.count > 0) {
    return stopped_at(path, ErrorCode::kBadFile, "out-of-gamut", stats.outside.moved(source_.offset()),
                      "--out-of-gamut clip or keep converts them");
  }
  return {};
}

Result<Upsampler> upsampler_for(const MethodOptions& options) {
  UpsamplerOptions out;
  const GamutPolicy gamut = options.out_of_gamut.value_or(
      options.negative == NegativeInput::kKeep ? GamutPolicy::kKeep : GamutPolicy::kClip);
  if (gamut == GamutPolicy::kKeep) out.negative = NegativeSamples::kKeep;
  if (options.light) out.light = options.light->spectrum;
  out.observer = options.observer;
  out.nodes = options.nodes;
  return Upsampler::create(options.method, options.quantity, options.bands, out);
}

void note_nodes(const Upsampler& upsampler, std::vector<std::string>& notes) {
  const auto& grid = UpsamplerAccess::grid(upsampler);
  if (!grid || grid->grid.weakened == 0) return;
  notes.push_back(
      fmt::format("{} of {} nodes of tetrahedral have less of what was learned, or nothing: with all "
                  "of it no spectrum has their colour",
                  grid->grid.weakened, kNodes));
}

}  // namespace spectile::io
