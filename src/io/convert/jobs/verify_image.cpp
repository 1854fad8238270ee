// verify_image: kernels, scalar reference and double oracle on every pixel of a file.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <spectile/image/image.hpp>

#include "src/base/errors.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/color/working_space.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/rgb_source.hpp"
#include "src/io/convert/sources/spectral_source.hpp"
#include "src/io/convert/stages/color_stage.hpp"
#include "src/io/convert/stages/lines.hpp"
#include "src/io/convert/stages/straight_color.hpp"
#include "src/lanes/tiles.hpp"
#include "src/reference/oracle/oracle.hpp"
#include "src/reference/table.hpp"
#include "src/upsampling/grid/color_grid.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile {
namespace {

constexpr double kUlp = 0x1p-24;  // half a unit in the last place of 1: the error of one rounding

constexpr double kSigmoidBound = 1e-6;    // that coefficients() states for the RGB of samples
constexpr double kGridBound = 12 * kUlp;  // docs/accuracy.md, and rounding of the nodes

/// NaN of any kind are the same result; their payload is not specified.
bool same_result(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

void compare(const float* kernel, const float* expected, std::size_t n, VerifyReport& report) {
  for (std::size_t i = 0; i < n; ++i) {
    if (same_result(kernel[i], expected[i])) continue;
    ++report.different_samples;
    const double difference = std::abs(static_cast<double>(kernel[i]) - static_cast<double>(expected[i]));
    report.max_kernel_difference =
        std::max(report.max_kernel_difference, std::isnan(difference) ? INFINITY : difference);
  }
  report.samples += n;
}

void merge(const VerifyReport& from, VerifyReport& into) {
  into.samples += from.samples;
  into.different_samples += from.different_samples;
  into.max_kernel_difference = std::max(into.max_kernel_difference, from.max_kernel_difference);
  into.max_oracle_difference = std::max(into.max_oracle_difference, from.max_oracle_difference);
}

/// The double oracle of one colour.
struct UpsamplingOracle {
  const Upsampler& upsampler;
  std::vector<std::array<double, 7>> basis;  // of methods that mix bases
  std::optional<WorkingSpace> space;         // of the sigmoids
  const GridModel* grid = nullptr;           // of tetrahedral
  double largest_basis = 0;                  // or node

  /// Largest error of a colour's samples, over the largest possible one; for the sigmoid, of the RGB that its
  /// samples come back as. None where the method states no bound. `scale`: of the spectrum.
  std::optional<double> difference(const std::array<double, 3>& straight, double scale,
                                   std::span<const float> samples) const {
    if (grid != nullptr) return of_mixture(straight, scale, samples);
    const std::array<double, 3> rgb = {scale * straight[0], scale * straight[1], scale * straight[2]};
    const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
    if (space) {
      const double size = upsampler.quantity() == Quantity::kReflectance ? 1.0 : *high;
      if (!(*low >= 0 && *high <= size && *high > 0x1p-100) || !std::isfinite(*high)) return {};
      double most = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        double sum = 0;
        for (std::size_t b = 0; b < samples.size(); ++b) {
          sum += space->weights[b][k] * static_cast<double>(samples[b]);
        }
        most = std::max(most, std::abs(sum - rgb[k]) / size);
      }
      return most;
    }
    const double size = (std::abs(*low) + (*high - *low)) * largest_basis;
    if (!(size > 0x1p-100) || !std::isfinite(size)) return {};
    const auto reference = oracle::smits_spectrum(basis, rgb, upsampler.lowest());
    double most = 0;
    for (std::size_t b = 0; b < samples.size(); ++b) {
      most = std::max(most, std::abs(static_cast<double>(samples[b]) - reference[b]) / size);
    }
    return most;
  }

 private:
  std::optional<double> of_mixture(const std::array<double, 3>& rgb, double scale,
                                   std::span<const float> samples) const {
    const NodeMixture mixture = node_mixture(rgb, grid->table.homogeneous);
    double size = 0;
    for (const double weight : mixture.weight) size += std::abs(scale * weight) * largest_basis;
    if (!(size > 0x1p-100) || !(size <= static_cast<double>(std::numeric_limits<float>::max()))) return {};
    double most = 0;
    for (std::size_t b = 0; b < samples.size(); ++b) {
      double sample = 0;
      for (std::size_t i = 0; i < 4; ++i)
        sample += scale * mixture.weight[i] * grid->grid.node(mixture.node[i])[b];
      sample = std::max(sample, static_cast<double>(upsampler.lowest()));
      const double difference = std::abs(static_cast<double>(samples[b]) - sample) / size;
      most = std::isnan(difference) ? INFINITY : std::max(most, difference);
    }
    return most;
  }
};

Result<UpsamplingOracle> oracle_of(const Upsampler& upsampler, const MethodOptions& options) {
  UpsamplingOracle out{upsampler, {}, {}};
  if (const auto& grid = UpsamplerAccess::grid(upsampler)) {
    out.grid = grid.get();
    for (const double v : grid->grid.nodes) out.largest_basis = std::max(out.largest_basis, std::abs(v));
    return out;
  }
  if (!rows::mixes_bases(upsampler)) {
    const MeasuredSpectrum light = options.light ? options.light->spectrum : *illuminant("D65");
    SPECTILE_ASSIGN(out.space, working_space(options.bands, options.quantity == Quantity::kIlluminant,
                                             kRec709, light, options.observer));
    return out;
  }
  // The published bases have an oracle of their own; the exact ones are double already.
  const bool published = options.method == Method::kSmits || options.method == Method::kSmits1999;
  const auto basis = upsampler.basis();
  // The oracle averages over bands; a plan's points are held to their own tables in double.
  out.basis = published && options.bands.weights() == nullptr
                  ? oracle::smits_basis(options.method, options.quantity, options.bands)
                  : std::vector<std::array<double, 7>>(basis.begin(), basis.end());
  for (const auto& band : out.basis) {
    for (const double v : band) out.largest_basis = std::max(out.largest_basis, std::abs(v));
  }
  return out;
}

/// Upsampling of one line of RGB, three ways. `scale`: of each pixel's spectrum; may be null.
Result<void> verify_upsampled(const kernels::KernelTable& kernels, const UpsamplingOracle& oracle,
                              const float* const rgb[3], const float* scale, std::size_t width,
                              VerifyReport& report) {
  const Upsampler& upsampler = oracle.upsampler;
  const std::size_t bands = upsampler.bands().count();
  SPECTILE_ASSIGN(auto memory, FloatBuffer::create(2 * bands * kLanesPerBlock));
  float* const ours = memory.data();
  float* const expected = ours + bands * kLanesPerBlock;
  const auto run = [&](const kernels::KernelTable& table, const float* const in[3], const float* scales,
                       float* out) {
    alignas(64) float c[4][kLanesPerBlock];
    const float* const read[3] = {c[0], c[1], c[2]};
    const rows::Coefficients found = {{c[0], c[1], c[2]}, rows::has_scale(upsampler) ? c[3] : nullptr};
    std::uint64_t unsolved = 0;
    rows::solve(table, upsampler, in, found, &unsolved, kLanesPerBlock);
    rows::expand_blocks(table, upsampler, read, scales != nullptr ? scales : found.scale, out, 1, false);
  };
  std::vector<float> samples(bands);
  for (std::size_t at = 0; at < width; at += kLanesPerBlock) {
    const float* const in[3] = {rgb[0] + at, rgb[1] + at, rgb[2] + at};
    const float* const scales = scale != nullptr ? scale + at : nullptr;
    run(kernels, in, scales, ours);
    run(reference::kKernelTable, in, scales, expected);
    compare(ours, expected, bands * kLanesPerBlock, report);
    for (std::size_t i = 0; i < std::min(kLanesPerBlock, width - at); ++i) {
      for (std::size_t b = 0; b < bands; ++b) samples[b] = expected[b * kLanesPerBlock + i];
      const double s = scales != nullptr ? static_cast<double>(scales[i]) : 1;
      const auto difference = oracle.difference({in[0][i], in[1][i], in[2][i]}, s, samples);
      if (difference) report.max_oracle_difference = std::max(report.max_oracle_difference, *difference);
    }
  }
  return {};
}

/// Projection of one line of spectra, three ways.
Result<void> verify_projected(const kernels::KernelTable& kernels, const io::SpectralSource& source,
                              const io::Strip& strip, int line, const Projector& projector,
                              const std::vector<std::array<double, 3>>& oracle_weights,
                              VerifyReport& report) {
  const std::size_t bands = source.samples();
  SPECTILE_ASSIGN(auto memory, FloatBuffer::create((bands + 6) * kLanesPerBlock));
  float* const block = memory.data();
  float* const ours = block + bands * kLanesPerBlock;
  float* const expected = ours + 3 * kLanesPerBlock;
  const auto width = static_cast<std::size_t>(source.width());
  std::vector<double> spectrum(bands);
  for (std::size_t at = 0; at < width; at += kLanesPerBlock) {
    source.block(kernels, strip, line, at, block);
    const auto run = [&](const kernels::KernelTable& table, float* out) {
      float* const dst[3] = {out, out + kLanesPerBlock, out + 2 * kLanesPerBlock};
      table.project(dst, block, ProjectorAccess::weights(projector), bands, 1);
    };
    run(kernels, ours);
    run(reference::kKernelTable, expected);
    compare(ours, expected, 3 * kLanesPerBlock, report);
    for (std::size_t i = 0; i < std::min(kLanesPerBlock, width - at); ++i) {
      std::array<double, 3> size{};
      for (std::size_t b = 0; b < bands; ++b) {
        spectrum[b] = block[b * kLanesPerBlock + i];
        for (std::size_t k = 0; k < 3; ++k) size[k] += std::abs(oracle_weights[b][k] * spectrum[b]);
      }
      const auto reference = oracle::project(oracle_weights, spectrum);
      for (std::size_t k = 0; k < 3; ++k) {
        if (!(size[k] > 0x1p-100) || !std::isfinite(size[k])) continue;
        const double difference =
            std::abs(static_cast<double>(expected[k * kLanesPerBlock + i]) - reference[k]);
        report.max_oracle_difference = std::max(report.max_oracle_difference, difference / size[k]);
      }
    }
  }
  return {};
}

/// Runs check(line number, line's report) over the lines of a strip on all threads.
template <class Check>
Result<void> over_lines(int first, int lines, int threads, VerifyReport& total, Check check) {
  std::vector<VerifyReport> reports(static_cast<std::size_t>(lines));
  std::vector<Result<void>> results(static_cast<std::size_t>(lines));
  Execution execution;
  execution.threads = threads;
  execution.tile_lanes = kLanesPerBlock;
  tiles::for_blocks(reports.size(), execution, [&](std::size_t i, std::size_t) {
    results[i] = check(first + static_cast<int>(i), reports[i]);
  });
  for (std::size_t i = 0; i < reports.size(); ++i) {
    SPECTILE_TRY(results[i]);
    merge(reports[i], total);
  }
  return {};
}

/// Tells how far a check is. Errors: kCancelled.
Result<void> go_on(const MethodOptions& options, int lines, int width, int height) {
  const auto w = static_cast<std::uint64_t>(width);
  const Progress progress = {static_cast<std::uint64_t>(lines) * w, static_cast<std::uint64_t>(height) * w};
  if (!options.progress || options.progress(progress)) return {};
  return make_error(ErrorCode::kCancelled, "stopped on request");
}

Result<VerifyReport> verify_rgb(io::RgbSource& source, const MethodOptions& options,
                                const kernels::KernelTable& kernels) {
  SPECTILE_ASSIGN(const auto upsampler, io::upsampler_for(options));
  SPECTILE_ASSIGN(const auto oracle, oracle_of(upsampler, options));
  const io::ColorStage stage(source, upsampler, options, kernels);
  const io::StraightColor straight(source, upsampler, options, kernels);
  std::atomic<std::uint64_t> divided = 0;
  std::atomic<std::uint64_t> above = 0;
  VerifyReport report;
  report.isa = kernels.name;
  report.what = fmt::format("{} {}, {} bands", to_string(options.method), to_string(options.quantity),
                            options.bands.count());
  report.oracle_bound = rows::mixes_bases(upsampler)  ? 6 * kUlp
                        : rows::stores_rgb(upsampler) ? kGridBound
                                                      : kSigmoidBound;
  const int step = io::strip_lines(source.header(), source.planes(), 1);
  for (int first = 0; first < source.height(); first += step) {
    const int lines = std::min(step, source.height() - first);
    SPECTILE_ASSIGN(const auto strip, source.read(first, lines));
    SPECTILE_TRY(
        over_lines(first, lines, options.threads, report, [&](int line, VerifyReport& found) -> Result<void> {
          SPECTILE_ASSIGN(auto color, io::ColorLine::create(source.width()));
          const auto width = static_cast<std::size_t>(source.width());
          const float* const rgb[3] = {color.rows[0], color.rows[1], color.rows[2]};
          io::LineStats stats;
          FloatBuffer scale;
          stage.load(*strip, line, color);
          const bool may_be_outside = stage.sanitize(line, color, width, stats).may_be_outside;
          if (straight.needed()) {
            SPECTILE_ASSIGN(scale, FloatBuffer::create(color.padded));
            straight.divide(*strip, line, color.rows, scale.data(), stats);
            divided += stats.divided_by_alpha;
            above += stats.above_alpha;
          }
          if (may_be_outside) stage.clip_to_gamut(line, color, width, stats);
          return verify_upsampled(kernels, oracle, rgb, straight.needed() ? scale.data() : nullptr, width,
                                  found);
        }));
    SPECTILE_TRY(go_on(options, first + lines, source.width(), source.height()));
  }
  report.pixels = static_cast<std::uint64_t>(source.width()) * static_cast<std::uint64_t>(source.height());
  report.notes = source.notes();
  io::LineStats of_alpha;
  of_alpha.divided_by_alpha = divided;
  of_alpha.above_alpha = above;
  io::note_alpha(of_alpha, !options.alpha, report.notes);
  return report;
}

Result<VerifyReport> verify_spectral(io::SpectralSource& source, const MethodOptions& options,
                                     const kernels::KernelTable& kernels) {
  const bool light = source.quantity() == Quantity::kIlluminant;
  SPECTILE_ASSIGN(const auto d65, illuminant("D65"));
  std::vector<BandPair> band_pairs;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const io::ReradiationChannel& channel : source.reradiation()) {
    band_pairs.push_back({channel.from_band, channel.to_band});
    pairs.emplace_back(channel.from_band, channel.to_band);
  }
  SPECTILE_ASSIGN(const auto projector, light ? Projector::emissive(source.bands())
                                              : Projector::reradiating(source.bands(), d65, band_pairs));
  // A plan's weights are given; the oracle integrates those of other bands itself.
  const auto own = projector.weights();
  const auto weights =
      source.bands().weights() != nullptr
          ? std::vector<std::array<double, 3>>(own.begin(), own.end())
          : oracle::projection_weights(source.bands(), Observer::kCie1931, light ? nullptr : &d65, pairs);
  VerifyReport report;
  report.isa = kernels.name;
  report.what =
      fmt::format("projection of {}, {} bands", to_string(source.quantity()), source.bands().count());
  // Roundings of the sum and of the weights, and what the oracle's own sum at 0.01 nm is off by.
  report.oracle_bound = static_cast<double>(source.samples() + 2) * kUlp + 1e-8;
  const int step = io::strip_lines(source.header(), source.planes(), 1);
  for (int first = 0; first < source.height(); first += step) {
    const int lines = std::min(step, source.height() - first);
    SPECTILE_ASSIGN(const auto strip, source.read(first, lines));
    SPECTILE_TRY(over_lines(first, lines, options.threads, report, [&](int line, VerifyReport& found) {
      return verify_projected(kernels, source, *strip, line, projector, weights, found);
    }));
    SPECTILE_TRY(go_on(options, first + lines, source.width(), source.height()));
  }
  report.pixels = static_cast<std::uint64_t>(source.width()) * static_cast<std::uint64_t>(source.height());
  return report;
}

Result<VerifyReport> verify(const std::string& path, const MethodOptions& options) {
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  const int threads = tiles::thread_count(options.threads);
  SPECTILE_ASSIGN(const auto input, io::ExrInput::open(path, threads));
  if (!options.channels.map.empty() || !io::spectral_sets(*input).empty()) {
    SPECTILE_ASSIGN(auto spectral,
                    io::SpectralSource::open(path, options.channels, std::nullopt, threads, options.region));
    SPECTILE_ASSIGN(auto report, verify_spectral(*spectral, options, *kernels));
    report.notes = spectral->notes();
    return report;
  }
  SPECTILE_ASSIGN(auto rgb,
                  io::RgbSource::open(path, options.channels, threads, options.region, options.input_space));
  return verify_rgb(*rgb, options, *kernels);
}

}  // namespace

Result<VerifyReport> verify_image(const std::string& path, const MethodOptions& options) {
  return io::contained<VerifyReport>(path, [&] { return verify(path, options); });
}

}  // namespace spectile
