// project_image: a spectral image becomes sRGB, XYZ or luminance, line by line.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <spectile/constants.hpp>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "src/base/errors.hpp"
#include "src/color/color_matrix.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/jobs/color_job.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/sources/spectral_source.hpp"
#include "src/io/convert/stages/lines.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

/// From the samples of a pixel to its colour.
struct ColorWeights {
  std::vector<float> weights;      // [samples][4], three and 0
  std::vector<float> luminance;    // [samples]
  std::optional<Matrix3> convert;  // of what the weights make to the colour
  double white_compensation = 1;

  /// Appends those of a projector, times a factor and, where it is given, a matrix.
  void add(const Projector& projector, double factor, const std::optional<Matrix3>& matrix) {
    white_compensation = std::min(white_compensation, projector.white_compensation());
    for (std::array<double, 3> w : projector.weights()) {
      if (matrix) w = times(*matrix, w);
      for (const double v : w) weights.push_back(static_cast<float>(v * factor));
      weights.push_back(0.0F);
      luminance.push_back(static_cast<float>(w[1] * factor));
    }
  }
};

class ProjectJob : public io::ColorJob {
 public:
  ProjectJob(io::SpectralSource& source, const ColorWeights& weights, const ProjectImageOptions& options,
             const kernels::KernelTable& kernels)
      : ColorJob(source, source.samples(), io::color_channels(options.target), options, kernels),
        source_(source),
        weights_(weights),
        options_(options) {
    if (weights.convert) matrix_ = color::to_float(*weights.convert);
  }

 private:
  std::size_t spectra_floats(std::size_t /*width*/) const override {
    return source_.samples() * kLanesPerBlock * tile_blocks();
  }

  void make_colors(std::size_t slot, const Strip& strip, int line, io::ColorLine& color, LineStats& stats,
                   bool /*checks_only*/) override {
    const auto width = static_cast<std::size_t>(strip.width);
    float* const* rows = color.rows;
    project_line(spectra(slot), strip, line, color);
    io::sanitize_nonfinite(kernels(), rows, width, line, options_.nonfinite, stats);
    if (weights_.convert) {
      const float* const xyz[3] = {rows[0], rows[1], rows[2]};
      kernels().transform3(rows, xyz, matrix_.data(), color.padded);
    }
    io::sanitize_range(kernels(), rows, width, line, NegativeInput::kKeep, stats);
  }

  /// Blocks that are gathered and then projected together; they stay in the caches.
  std::size_t tile_blocks() const {
    const std::size_t line = blocks_for(static_cast<std::size_t>(source_.width()));
    return std::clamp<std::size_t>(options_.tile_lanes / kLanesPerBlock, 1, std::min<std::size_t>(line, 16));
  }

  void project_line(float* spectra, const Strip& strip, int line, io::ColorLine& color) const {
    const std::size_t blocks = blocks_for(static_cast<std::size_t>(strip.width));
    const std::size_t bands = source_.samples();
    float* const* rows = color.rows;
    for (std::size_t first = 0; first < blocks; first += tile_blocks()) {
      const std::size_t count = std::min(tile_blocks(), blocks - first);
      const std::size_t at = first * kLanesPerBlock;
      for (std::size_t b = 0; b < count; ++b) {
        source_.block(kernels(), strip, line, at + b * kLanesPerBlock, spectra + b * bands * kLanesPerBlock);
      }
      if (options_.target == ColorTarget::kLuminance) {
        kernels().weighted_sum(rows[0] + at, spectra, weights_.luminance.data(), bands, count);
      } else {
        float* const dst[3] = {rows[0] + at, rows[1] + at, rows[2] + at};
        kernels().project(dst, spectra, weights_.weights.data(), bands, count);
      }
    }
    if (options_.target == ColorTarget::kLuminance) {
      // The checks look at three components; luminance is all of them.
      for (std::size_t k : {1U, 2U}) std::memcpy(rows[k], rows[0], color.padded * sizeof(float));
    }
  }

  io::SpectralSource& source_;
  const ColorWeights& weights_;
  const ProjectImageOptions& options_;
  std::array<float, 9> matrix_{};
};

Result<Projector> projector_for(const io::SpectralSource& source, const std::string& input,
                                const ProjectImageOptions& options) {
  if (source.quantity() == Quantity::kIlluminant) {
    if (options.light) {
      return make_error(ErrorCode::kBadArgument, "{}: holds light, not reflectances; it takes no illuminant",
                        input);
    }
    return Projector::emissive(source.bands(), options.observer);
  }
  SPECTILE_ASSIGN(const auto d65, illuminant("D65"));
  std::vector<BandPair> pairs;
  for (const io::ReradiationChannel& channel : source.reradiation()) {
    pairs.push_back({channel.from_band, channel.to_band});
  }
  return Projector::reradiating(source.bands(), options.light.value_or(d65), pairs, options.observer);
}

/// Luminance in cd/m2 of a radiance of 1 W / (m2 sr nm) in every band. Errors: kBadArgument for another
/// observer than that of 1931, whose y-bar is the luminous efficiency function, and for planned bands.
Result<double> luminance_of_one(const Bands& bands, Observer observer) {
  if (observer != Observer::kCie1931 || bands.weights() != nullptr) {
    return make_error(ErrorCode::kBadArgument,
                      "cd/m2 are defined for the observer of 1931 and bands that are not planned");
  }
  SPECTILE_ASSIGN(const auto efficiency, named_spectrum("cie1931-y"));
  double nm = 0;
  for (const Band& band : bands.list()) nm += efficiency.integral(band.lower_nm, band.upper_nm);
  return kMaxLuminousEfficacy.value() * nm;
}

/// Errors: those of projector_for(), Projector::emissive() and luminance_of_one().
Result<ColorWeights> weights_for(const io::SpectralSource& source, const std::string& input,
                                 const ProjectImageOptions& options) {
  SPECTILE_ASSIGN(const auto projector, projector_for(source, input, options));
  ColorWeights out;
  const Matrix3 matrix = io::color_matrix(projector, options.target, options.adaptation);
  if (options.emission) {
    // Each quantity has a white of its own, so the way to sRGB goes into the weights.
    SPECTILE_ASSIGN(const auto emissive, Projector::emissive(source.emission_bands(), options.observer));
    const bool srgb = options.target == ColorTarget::kSrgb;
    out.add(projector, 1, srgb ? std::optional(matrix) : std::nullopt);
    out.add(emissive, *options.emission, srgb ? std::optional(emissive.xyz_to_srgb()) : std::nullopt);
    return out;
  }
  double scale = 1;
  if (options.photometric) {
    SPECTILE_ASSIGN(scale, luminance_of_one(source.bands(), options.observer));
  }
  out.add(projector, scale, std::nullopt);
  // XYZ without an adaptation, and luminance, are the projector's own.
  if (options.target == ColorTarget::kSrgb ||
      (options.target == ColorTarget::kXyz && options.adaptation != Adaptation::kNone)) {
    out.convert = matrix;
  }
  return out;
}

/// Refuses options that do not go with what the file holds.
Result<void> check_options(const io::SpectralSource& source, const std::string& input,
                           const ProjectImageOptions& options) {
  const bool light = source.quantity() == Quantity::kIlluminant;
  const auto refuse = [&](const char* why) {
    return make_error(ErrorCode::kBadArgument, "{}: {}", input, why);
  };
  if (options.adaptation != Adaptation::kNone) {
    if (light || options.emission) return refuse("holds light, whose white is not adapted");
    if (options.target == ColorTarget::kLuminance) return refuse("luminance alone cannot be adapted");
  }
  if (options.emission && !std::isfinite(*options.emission))
    return refuse("the scale of emission is not finite");
  if (options.photometric && (!light || options.emission)) {
    return refuse("holds reflectances, which have no luminance in cd/m2; emission alone has");
  }
  return {};
}

void add_notes(const ColorWeights& weights, const ProjectImageOptions& options,
               std::vector<std::string>& notes) {
  if (options.emission) {
    notes.push_back(fmt::format(
        "reflected and emitted light are added: Y is 1 for reflectance 1 under the illuminant, and {} for "
        "emission 1 in every band (--emission-scale)",
        *options.emission));
  }
  if (options.photometric) {
    notes.emplace_back("emission is taken as W / (m2 sr nm), so that Y is in cd/m2");
  }
  if (options.target == ColorTarget::kSrgb) io::note_white(weights.white_compensation, notes);
}

Result<ImageReport> project_file(const std::string& input, const std::string& output,
                                 const ProjectImageOptions& options) {
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(std::array{input}, output, options));
  SPECTILE_ASSIGN(auto source, io::SpectralSource::open(
                                   input, options.channels, options.quantity, setup.threads, options.region,
                                   options.emission ? io::SpectralContent::kBothQuantities
                                                    : io::SpectralContent::kOneQuantity));
  SPECTILE_TRY(check_options(*source, input, options));
  SPECTILE_ASSIGN(const auto weights, weights_for(*source, input, options));

  ProjectJob job(*source, weights, options, setup.kernels);
  io::TextAttributes texts;
  io::add_color_tag(texts, options.target);
  io::ImageSpec spec = io::conversion_spec(source->header(), job.channels(), std::move(texts), options,
                                           settings_text(options));
  // The output is linear sRGB or CIE, whatever space the input's preview was in.
  spec.replaced = io::method_attribute_names();
  spec.change = io::PixelChange::kColor;
  ImageReport known;
  known.bands = source->bands().count();
  known.quantity = source->quantity();
  known.notes = source->notes();
  add_notes(weights, options, known.notes);
  return io::run_image_job({job, output, std::move(spec), options,
                            io::at_nonfinite(input, options, source->offset()), std::move(known)});
}

}  // namespace

Result<ImageReport> project_image(const std::string& input, const std::string& output,
                                  const ProjectImageOptions& options) {
  return io::timed(input, [&] { return project_file(input, output, options); });
}

}  // namespace spectile
