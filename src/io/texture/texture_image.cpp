// A SpectralTexture's image: its file and channels, regions and lanes of it.
#include "src/io/texture/texture_image.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/io/channels/plan_attribute.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using io::Strip;

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

Result<std::shared_ptr<SpectralTexture::Image>> SpectralTexture::Image::open(const std::string& path,
                                                                             const TextureOptions& options) {
  auto image = std::make_shared<Image>();
  image->threads_ = tiles::thread_count(options.threads);
  image->cache_ = options.cache;
  if (!image->cache_) {
    SPECTILE_ASSIGN(image->cache_, TextureCache::create());
  }
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

}  // namespace spectile
