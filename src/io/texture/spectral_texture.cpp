// SpectralTexture: the spectra of a part of an image at the wavelengths asked for, whichever way they are
// stored.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <spectile/image/spectral_texture.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/channels/plan_attribute.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"
#include "src/io/convert/sources/spectral_source.hpp"
#include "src/io/texture/evaluators.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using io::Strip;

Result<void> check_region(const PixelWindow& r, int width, int height) {
  if (!r.empty() && r.x0 >= 0 && r.y0 >= 0 && r.x1 <= width && r.y1 <= height) return {};
  return make_error(ErrorCode::kBadArgument,
                    "a region of {} x {} pixels at {},{} is not one of the image's {} x {}",
                    std::int64_t{r.x1} - r.x0, std::int64_t{r.y1} - r.y0, r.x0, r.y0, width, height);
}

/// Bands centred at wavelengths, edges halfway; unlike Bands::from_centres(), the first may reach down to 0.
Result<Bands> bands_at(std::span<const double> wavelengths_nm) {
  const std::size_t n = wavelengths_nm.size();
  if (n == 0 || n > Bands::kMaxBands) {
    return make_error(ErrorCode::kBadArgument, "{} wavelengths: there must be 1 to {}", n, Bands::kMaxBands);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i == 0 ? 0 : wavelengths_nm[i - 1];
    if (wavelengths_nm[i] > before && std::isfinite(wavelengths_nm[i])) continue;
    return make_error(ErrorCode::kBadArgument,
                      "wavelength {} of {}, {} nm after {} nm: they must be positive and ascend strictly",
                      i + 1, n, wavelengths_nm[i], before);
  }
  std::vector<Band> list(n);
  for (std::size_t i = 0; i < n; ++i) list[i].centre_nm = wavelengths_nm[i];
  for (std::size_t i = 0; i + 1 < n; ++i) {
    list[i].upper_nm = list[i + 1].lower_nm = 0.5 * (wavelengths_nm[i] + wavelengths_nm[i + 1]);
  }
  Band& first = list.front();
  Band& last = list.back();
  if (n == 1) first.upper_nm = first.centre_nm + 0.5;
  first.lower_nm = std::max(0.0, 2 * first.centre_nm - first.upper_nm);
  if (n > 1) last.upper_nm = 2 * last.centre_nm - last.lower_nm;
  return Bands::from_list(std::move(list));
}

/// A line of any length into the batch from `lane` on, cut where the batch's blocks end.
void evaluate_line(const kernels::KernelTable& kernels, const io::Evaluator& evaluator, const io::Piece& line,
                   std::size_t lane, const SampledSpectraSpan& spectra) {
  const std::size_t bands = spectra.axis.count();
  void* out[Bands::kMaxBands];
  for (std::size_t at = 0; at < line.n;) {
    const std::size_t within = (lane + at) % kLanesPerBlock;
    const std::size_t n = std::min(kLanesPerBlock - within, line.n - at);
    float* const block = spectra.data + (lane + at - within) * bands;
    for (std::size_t b = 0; b < bands; ++b) out[b] = block + b * kLanesPerBlock + within;
    evaluator.piece(kernels, {line.strip, line.line, line.x + at, n}, out);
    at += n;
  }
}

}  // namespace

/// The state that copies of a texture share.
class SpectralTexture::Image {
 public:
  static Result<std::shared_ptr<Image>> open(const std::string& path, int threads);

  int width() const { return file().header(part_).width(); }
  int height() const { return file().header(part_).height(); }
  Quantity quantity() const { return source_ ? source_->upsampler().quantity() : quantity_; }
  const Bands& bands() const { return source_ ? source_->upsampler().bands() : bands_; }
  bool compact() const { return source_ != nullptr; }
  const std::string& path() const { return file().path(); }
  std::uint64_t samples_read() const { return samples_read_; }

  Result<void> evaluate(const PixelWindow& region, SampledSpectraSpan spectra);

 private:
  Result<void> choose_channels(const io::SpectralSet& set);
  Result<std::unique_ptr<io::Evaluator>> evaluator_for(const Bands& bands) const;
  Result<void> read(const std::vector<io::PlaneSpec>& planes, Strip& strip);
  io::ExrInput& file() const { return source_ ? source_->input() : *input_; }

  std::unique_ptr<io::CoefficientSource> source_;  // of a compact image
  std::unique_ptr<io::ExrInput> input_;            // of a full one
  std::mutex reading_;
  std::atomic<std::uint64_t> samples_read_ = 0;
  int part_ = 0;
  int threads_ = 0;
  Quantity quantity_ = Quantity::kReflectance;
  Bands bands_;
  std::vector<io::PlaneSpec> channels_;  // of all bands
};

Result<std::shared_ptr<SpectralTexture::Image>> SpectralTexture::Image::open(const std::string& path,
                                                                             int threads) {
  auto image = std::make_shared<Image>();
  image->threads_ = tiles::thread_count(threads);
  SPECTILE_ASSIGN(auto input, io::ExrInput::open(path, image->threads_));
  for (int part = 0; part < input->parts(); ++part) {
    if (input->header(part).deep()) continue;
    image->part_ = part;
    if (io::claims_coefficients(input->header(part))) {
      SPECTILE_ASSIGN(image->source_, io::CoefficientSource::open(std::move(input)));
      return image;
    }
  }
  std::vector<std::string> notes;
  SPECTILE_ASSIGN(const auto set, io::choose_spectra(*input, {}, std::nullopt, notes));
  if (set) {
    image->part_ = set->part;
    image->input_ = std::move(input);
    SPECTILE_TRY(image->choose_channels(*set));
    return image;
  }
  return make_error(ErrorCode::kBadFile,
                    "{}: has neither spectral channels (T.*nm, S0.*nm) nor coefficients (spectile.c0, ...)",
                    path);
}

Result<void> SpectralTexture::Image::choose_channels(const io::SpectralSet& set) {
  if (!set.reradiating.empty()) {
    return make_error(ErrorCode::kBadFile,
                      "{}: re-radiates (channels of two wavelengths); a texture only reflects", path());
  }
  quantity_ = set.quantity;
  SPECTILE_ASSIGN(bands_, set.bands(input_->header(part_), path()));
  SPECTILE_ASSIGN(channels_, io::band_planes(input_->header(part_), set, path()));
  return {};
}

Result<std::unique_ptr<io::Evaluator>> SpectralTexture::Image::evaluator_for(const Bands& bands) const {
  std::vector<double> centres;
  for (const Band& band : bands.list()) centres.push_back(band.centre_nm);
  if (!source_)
    return std::unique_ptr<io::Evaluator>(std::make_unique<io::FullEvaluator>(bands_, channels_, centres));
  SPECTILE_ASSIGN(auto rows, rows::SampledRows::at(source_->upsampler(), centres));
  auto planes = source_->planes();
  planes.resize(source_->coefficients());
  return std::unique_ptr<io::Evaluator>(
      std::make_unique<io::CompactEvaluator>(std::move(rows), std::move(planes)));
}

Result<void> SpectralTexture::Image::read(const std::vector<io::PlaneSpec>& planes, Strip& strip) {
  const std::scoped_lock lock(reading_);
  SPECTILE_TRY(io::fill_strip(file(), part_, planes, strip));
  samples_read_ +=
      static_cast<std::uint64_t>(width()) * static_cast<std::uint64_t>(strip.lines) * planes.size();
  return {};
}

Result<void> SpectralTexture::Image::evaluate(const PixelWindow& region, SampledSpectraSpan spectra) {
  SPECTILE_TRY(check_region(region, width(), height()));
  const auto w = static_cast<std::size_t>(region.width());
  SPECTILE_TRY(shape::same_lanes(w * static_cast<std::size_t>(region.height()), spectra.lanes));
  SPECTILE_TRY(shape::aligned(spectra.data));
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  if (spectra.axis.bands() == nullptr) {
    return make_error(ErrorCode::kBandsMismatch, "a region is evaluated on bands, the batch has {}",
                      spectra.axis.description());
  }
  SPECTILE_ASSIGN(const auto evaluator, evaluator_for(*spectra.axis.bands()));
  const std::vector<io::PlaneSpec>& planes = evaluator->planes();
  const std::size_t bands = spectra.axis.count();
  const int step = io::strip_lines(file().header(part_), planes, 1);
  for (int done = 0; done < region.height(); done += step) {
    const int first = region.y0 + done;
    const int lines = std::min(step, region.height() - done);
    SPECTILE_ASSIGN(auto strip, io::make_strip(planes, width(), first, lines));
    SPECTILE_TRY(read(planes, *strip));
    // Lines write different lanes. Some thousands of pixels are worth a thread's while.
    const Execution execution = {threads_, kLanesPerBlock * std::max<std::size_t>(1, 4096 / w)};
    tiles::for_blocks(static_cast<std::size_t>(lines), execution, [&](std::size_t begin, std::size_t count) {
      for (std::size_t line = begin; line < begin + count; ++line) {
        const io::Piece piece = {*strip, first + static_cast<int>(line), static_cast<std::size_t>(region.x0),
                                 w};
        evaluate_line(*kernels, *evaluator, piece, (static_cast<std::size_t>(done) + line) * w, spectra);
      }
    });
  }
  // The last block's padding is defined too.
  const std::size_t rest = spectra.lanes % kLanesPerBlock;
  for (std::size_t b = 0; b < bands && rest != 0; ++b) {
    float* const row = spectra.data + ((spectra.lanes - rest) * bands + b * kLanesPerBlock);
    std::fill(row + rest, row + kLanesPerBlock, 0.0F);
  }
  return {};
}

Result<SpectralTexture> SpectralTexture::open(const std::string& path, int threads) {
  return io::contained<SpectralTexture>(path, [&]() -> Result<SpectralTexture> {
    SPECTILE_ASSIGN(auto image, Image::open(path, threads));
    return SpectralTexture(std::move(image));
  });
}

int SpectralTexture::width() const noexcept {
  return image_->width();
}

int SpectralTexture::height() const noexcept {
  return image_->height();
}

Quantity SpectralTexture::quantity() const noexcept {
  return image_->quantity();
}

const Bands& SpectralTexture::bands() const noexcept {
  return image_->bands();
}

bool SpectralTexture::compact() const noexcept {
  return image_->compact();
}

std::uint64_t SpectralTexture::samples_read() const noexcept {
  return image_->samples_read();
}

Result<SampledSpectra> SpectralTexture::evaluate(const PixelWindow& region,
                                                 std::span<const double> wavelengths_nm) const {
  return io::contained<SampledSpectra>(image_->path(), [&]() -> Result<SampledSpectra> {
    SPECTILE_TRY(check_region(region, width(), height()));
    SPECTILE_ASSIGN(const auto bands, bands_at(wavelengths_nm));
    SPECTILE_ASSIGN(auto spectra,
                    SampledSpectra::create(bands, static_cast<std::size_t>(region.width()) *
                                                      static_cast<std::size_t>(region.height())));
    SPECTILE_TRY(image_->evaluate(region, spectra.span()));
    return spectra;
  });
}

Result<void> SpectralTexture::evaluate(const PixelWindow& region, SampledSpectraSpan spectra) const {
  return io::contained<void>(image_->path(), [&] { return image_->evaluate(region, spectra); });
}

}  // namespace spectile
