// polarisation_image: Stokes components become the degree or the angle of linear polarisation, line by line.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <spectile/image/polarisation.hpp>

#include "src/base/errors.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/jobs/color_job.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/sources/spectral_source.hpp"
#include "src/io/convert/stages/lines.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

double degree_of(double s0, double s1, double s2) {
  return s0 > 0 ? std::hypot(s1, s2) / s0 : 0;
}

double angle_of(double s1, double s2) {
  const double degrees = std::atan2(s2, s1) * (90 / std::numbers::pi);
  return degrees < 0 ? degrees + 180 : degrees;
}

class PolarisationJob : public io::ColorJob {
 public:
  PolarisationJob(io::SpectralSource& source, const Projector& projector,
                  const PolarisationImageOptions& options, const kernels::KernelTable& kernels)
      : ColorJob(source, source.samples(), {options.polarisation == Polarisation::kDegree ? "DOLP" : "AOLP"},
                 options, kernels),
        source_(source),
        projector_(projector),
        options_(options) {}

 private:
  std::size_t spectra_floats(std::size_t /*width*/) const override {
    return source_.samples() * kLanesPerBlock;
  }

  void make_colors(std::size_t slot, const Strip& strip, int line, io::ColorLine& color, LineStats& stats,
                   bool /*checks_only*/) override {
    const auto width = static_cast<std::size_t>(strip.width);
    const std::size_t bands = source_.bands().count();
    float* const* rows = color.rows;
    for (std::size_t at = 0; at < width; at += kLanesPerBlock) {
      source_.block(kernels(), strip, line, at, spectra(slot));
      for (std::size_t k = 0; k < 3; ++k) {
        kernels().weighted_sum(rows[k] + at, spectra(slot) + k * bands * kLanesPerBlock,
                               ProjectorAccess::luminance_weights(projector_), bands, 1);
      }
    }
    io::sanitize_nonfinite(kernels(), rows, width, line, options_.nonfinite, stats);
    for (std::size_t x = 0; x < width; ++x) {
      const double s0 = rows[0][x];
      const double s1 = rows[1][x];
      const double s2 = rows[2][x];
      const double degree = degree_of(s0, s1, s2);
      // Rounding of what is polarised throughout is not worth a word.
      stats.over_one += degree > 1 + 1e-5 ? 1 : 0;
      if (s0 < 0) stats.negative.add(1, static_cast<int>(x), line);
      rows[0][x] =
          static_cast<float>(options_.polarisation == Polarisation::kDegree ? degree : angle_of(s1, s2));
    }
  }

  io::SpectralSource& source_;
  const Projector& projector_;
  const PolarisationImageOptions& options_;
};

void remark(const LineStats& stats, std::vector<std::string>& notes) {
  if (stats.over_one > 0) {
    notes.push_back(fmt::format("{} pixels are polarised by more than 1, which no light is; they stay so",
                                stats.over_one));
  }
  if (stats.negative.count > 0) {
    notes.push_back(fmt::format("{} pixels have negative light; their degree is 0", stats.negative.count));
  }
}

Result<ImageReport> polarisation_file(const std::string& input, const std::string& output,
                                      const PolarisationImageOptions& options) {
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(std::array{input}, output, options));
  if (options.mipmap) {
    return make_error(ErrorCode::kBadArgument, "{}: degrees and angles of polarisation have no mip levels",
                      output);
  }
  SPECTILE_ASSIGN(auto source,
                  io::SpectralSource::open(input, options.channels, Quantity::kIlluminant, setup.threads,
                                           options.region, io::SpectralContent::kLinearPolarisation));
  SPECTILE_ASSIGN(const auto projector, Projector::emissive(source->bands(), options.observer));
  PolarisationJob job(*source, projector, options, setup.kernels);
  io::ImageSpec spec =
      io::conversion_spec(source->header(), job.channels(), {}, options, settings_text(options));
  spec.replaced = io::method_attribute_names();
  spec.change = io::PixelChange::kColor;
  ImageReport known;
  known.bands = source->bands().count();
  known.quantity = source->quantity();
  known.notes = source->notes();
  if (options.polarisation == Polarisation::kAngle) {
    known.notes.emplace_back("light that is not polarised has no angle; 0 is written for it");
  }
  return io::run_image_job({job, output, std::move(spec), options,
                            io::at_nonfinite(input, options, source->offset()), std::move(known), remark});
}

}  // namespace

Result<ImageReport> polarisation_image(const std::string& input, const std::string& output,
                                       const PolarisationImageOptions& options) {
  return io::timed(input, [&] { return polarisation_file(input, output, options); });
}

}  // namespace spectile
