// The state that copies of a SpectralTexture share.
#pragma once

#include <atomic>
#include <mutex>
#include <spectile/image/spectral_texture.hpp>

#include "src/io/convert/sources/coefficient_source.hpp"
#include "src/io/convert/sources/spectral_source.hpp"
#include "src/io/texture/evaluators.hpp"
#include "src/io/texture/texture_lookup.hpp"

namespace spectile {

/// The state that copies of a texture share.
class SpectralTexture::Image {
 public:
  static Result<std::shared_ptr<Image>> open(const std::string& path, const TextureOptions& options);

  int width() const { return file().header(part_).width(); }
  int height() const { return file().header(part_).height(); }
  Quantity quantity() const { return source_ ? source_->upsampler().quantity() : quantity_; }
  const Bands& bands() const { return source_ ? source_->upsampler().bands() : bands_; }
  bool compact() const { return source_ != nullptr; }
  const std::string& path() const { return file().path(); }
  std::uint64_t samples_read() const { return samples_read_; }

  Result<void> evaluate(const PixelWindow& region, SampledSpectraSpan spectra);

  /// See SpectralTexture::sample(); no wavelengths: at the centres of the batch's bands.
  Result<void> sample(const TexturePoints& at, const SampledSpectraView* lambda_nm,
                      SampledSpectraSpan samples, const TextureLookup& lookup, const Execution& execution);
  /// The tiles, opened when they are first asked for. Errors: kBadFile, kOutOfMemory.
  Result<io::TextureTiles*> tiles();
  const TextureCache& cache() const { return *cache_; }

 private:
  Result<void> choose_channels(const io::SpectralSet& set);
  Result<std::unique_ptr<io::Evaluator>> evaluator_for(const Bands& bands) const;
  Result<void> read(const std::vector<io::PlaneSpec>& planes, io::Strip& strip);
  Result<io::TexelFormat> texel_format() const;
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
  std::optional<TextureCache> cache_;
  std::mutex opening_;
  std::atomic<io::TextureTiles*> tiles_ = nullptr;
  std::unique_ptr<io::TextureTiles> own_tiles_;
  std::shared_ptr<const WavelengthTables> centres_;  // of a full one
};

}  // namespace spectile
