// convert_image: a spectral image in another dialect, in other bands or units.
#include <algorithm>
#include <cmath>
#include <set>
#include <spectile/image/convert.hpp>
#include <string_view>

#include "src/base/errors.hpp"
#include "src/io/channels/dialect_names.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/jobs/convert_header.hpp"
#include "src/io/convert/jobs/convert_job.hpp"
#include "src/io/convert/stages/resample.hpp"

namespace spectile {
namespace {

using io::SampleSum;
using io::SetsSource;
using io::SourceSpectra;

Result<const io::Dialect*> dialect_of(const ConvertImageOptions& options) {
  if (const io::Dialect* const found = io::find_dialect(options.dialect)) return found;
  return make_error(ErrorCode::kUnknownName, "dialect \"{}\" is none of {}", options.dialect,
                    fmt::join(spectral_dialects(), ", "));
}

Result<void> check_values(const SetsSource& source, const std::string& input,
                          const ConvertImageOptions& options) {
  const auto scale = static_cast<float>(options.scale);
  if (!(scale > 0) || !std::isfinite(scale)) {
    return make_error(ErrorCode::kBadArgument, "scale {} is not a positive number within the range of float",
                      options.scale);
  }
  const bool light = std::ranges::any_of(
      source.spectra(), [](const auto& s) { return s.set.quantity == Quantity::kIlluminant; });
  if (!options.units.empty() && !light) {
    return make_error(ErrorCode::kBadArgument, "{}: has no emission, whose units --units would state", input);
  }
  return {};
}

/// Errors: kBadArgument for spectra that have no averages over other bands.
Result<void> check_bands(const SourceSpectra& spectra, const std::string& input,
                         const ConvertImageOptions& options) {
  if (!options.bands) return {};
  if (options.bands->weights() != nullptr) {
    return make_error(
        ErrorCode::kBadArgument,
        "{}: planned bands are weighed by their plan, and averages over them (--bands) would be "
        "weighed wrongly",
        input);
  }
  if (spectra.bands.weights() != nullptr) {
    return make_error(ErrorCode::kBadArgument,
                      "{}: its bands are planned: {}, weighed by the plan, from which averages over other "
                      "bands (--bands) cannot be told",
                      input, spectra.bands.are_points() ? "values at their centres" : "averages");
  }
  if (!spectra.set.reradiating.empty()) {
    return make_error(ErrorCode::kBadArgument,
                      "{}: holds re-radiation, of pairs of bands, which --bands does not resample", input);
  }
  return {};
}

/// Errors: kBadArgument for what a dialect of light alone has no names for.
Result<void> check_dialect(const SetsSource& source, const std::string& input, const io::Dialect& dialect) {
  if (dialect.says_quantity) return {};
  if (source.spectra().size() > 1) {
    return make_error(ErrorCode::kBadArgument,
                      "{}: holds reflectance and emission, and {}'s channels are light alone; --quantity "
                      "illuminant takes the emission",
                      input, dialect.name);
  }
  if (!source.spectra().front().stokes.empty()) {
    return make_error(ErrorCode::kBadArgument,
                      "{}: holds polarised light, and {} has no names for Stokes components; the spectral "
                      "layout has",
                      input, dialect.name);
  }
  return {};
}

std::vector<io::BandAverage> averages_of(const SourceSpectra& spectra, const ConvertImageOptions& options,
                                         std::vector<std::string>& notes) {
  if (options.bands) return io::band_averages(spectra.bands, *options.bands, spectra.set.quantity, notes);
  std::vector<io::BandAverage> out;
  for (std::size_t b = 0; b < spectra.bands.count(); ++b) out.push_back({b, {1}});
  return out;
}

/// Errors: kBadArgument for a channel that passes through under a name of another, and for bands of one name.
Result<void> check_names(const std::vector<io::ChannelSpec>& channels, const std::string& input) {
  std::set<std::string_view> names;
  for (const io::ChannelSpec& channel : channels) {
    if (names.insert(channel.name).second) continue;
    return make_error(ErrorCode::kBadArgument, "{}: two channels of the output would be named \"{}\"", input,
                      channel.name);
  }
  return {};
}

/// Makes output channels of a source's planes.
class SumMaker {
 public:
  SumMaker(const SetsSource& source, const ConvertImageOptions& options)
      : source_(source), options_(options) {}

  void add(const io::ConvertedSpectra& spectra, const std::vector<io::BandAverage>& averages) {
    const SourceSpectra& from = *spectra.from;
    for (std::size_t b = 0; b < averages.size(); ++b) add(spectra.names[b].name, from.first, averages[b]);
    for (const io::StokesPlanes& stokes : from.stokes) {
      for (std::size_t b = 0; b < averages.size(); ++b) {
        add(io::stokes_channel_name(stokes.component, spectra.bands[b].centre_nm), stokes.first, averages[b]);
      }
    }
    std::size_t plane = from.first_reradiating;
    for (const auto& [name, channel] : from.set.reradiating) {
      add(io::reradiation_channel_name(channel.from_nm, channel.wavelength_nm), plane++, {0, {1}});
    }
  }

  std::vector<SampleSum> take() && { return std::move(sums_); }

 private:
  /// The sum of planes from `first_plane` on; its type is the widest of theirs.
  void add(std::string name, std::size_t first_plane, const io::BandAverage& average) {
    SampleSum sum;
    sum.first = first_plane + average.first;
    SampleType type = SampleType::kHalf;
    for (std::size_t i = 0; i < average.weights.size(); ++i) {
      // One rounding of both factors.
      sum.weights.push_back(static_cast<float>(average.weights[i] * options_.scale));
      if (source_.planes()[sum.first + i].type == SampleType::kFloat) type = SampleType::kFloat;
    }
    sum.channel = {std::move(name), options_.keep_depth ? type : options_.pixel};
    sums_.push_back(std::move(sum));
  }

  const SetsSource& source_;
  const ConvertImageOptions& options_;
  std::vector<SampleSum> sums_;
};

Result<ImageReport> convert_file(const std::string& input, const std::string& output,
                                 const ConvertImageOptions& options) {
  SPECTILE_ASSIGN(const io::Dialect* const dialect, dialect_of(options));
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(std::array{input}, output, options));
  SPECTILE_ASSIGN(auto source,
                  SetsSource::open(input, options.channels, options.quantity, setup.threads, options.region));
  SPECTILE_TRY(check_values(*source, input, options));
  SPECTILE_TRY(check_dialect(*source, input, *dialect));
  ImageReport known;
  known.notes = source->notes();
  std::vector<io::ConvertedSpectra> spectra;
  SumMaker maker(*source, options);
  for (const SourceSpectra& from : source->spectra()) {
    SPECTILE_TRY(check_bands(from, input, options));
    io::ConvertedSpectra to = {&from, options.bands.value_or(from.bands), {}};
    SPECTILE_ASSIGN(to.names, io::dialect_names(*dialect, to.bands, from.set.quantity, input, known.notes));
    maker.add(to, averages_of(from, options, known.notes));
    spectra.push_back(std::move(to));
  }
  known.bands = spectra.front().bands.count();
  known.quantity = spectra.front().from->set.quantity;
  if (spectra.size() > 1) {
    known.notes.push_back(fmt::format("both are converted: {} and {}", spectra[0].from->set.description(),
                                      spectra[1].from->set.description()));
  }

  io::ConvertJob job(*source, std::move(maker).take(), options, setup.kernels);
  SPECTILE_TRY(check_names(job.channels(), input));
  io::ImageSpec spec = io::converted_spec(*source, *dialect, spectra, job.channels(), options, known.notes);
  return io::run_image_job({job, output, std::move(spec), options,
                            io::at_nonfinite(input, options, source->offset()), std::move(known)});
}

}  // namespace

std::vector<std::string> spectral_dialects() {
  std::vector<std::string> out;
  for (const io::Dialect& dialect : io::dialects()) out.emplace_back(dialect.key);
  return out;
}

Result<ImageReport> convert_image(const std::string& input, const std::string& output,
                                  const ConvertImageOptions& options) {
  return io::timed(input, [&] { return convert_file(input, output, options); });
}

}  // namespace spectile
