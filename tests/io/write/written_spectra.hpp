// Spectra to write as images, and how they are written and read back.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <spectile/spectile.hpp>
#include <string>
#include <vector>

#include "tests/support/exr_files.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {

/// The usual options; named, since GCC 12 takes defaulted arguments with a std::function inside for
/// uninitialised.
inline const SpectralImageOptions kSpectralImage;

inline SpectralImageOptions as_floats() {
  SpectralImageOptions out;
  out.pixel = SampleType::kFloat;
  return out;
}

inline std::size_t pixels_of(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// Samples of noise from 0 to 1, other ones in every pixel and band.
inline SampledSpectra noise_spectra(const Bands& bands, int width, int height) {
  return batch_of(bands, pixels_of(width, height), [&](std::size_t lane, std::size_t band) {
    return static_cast<float>(noise(static_cast<int>(lane), 0, static_cast<int>(band)));
  });
}

/// Rows of an image as a batch of their own.
inline SampledSpectra rows_of(const SampledSpectra& image, int width, int first, int rows) {
  const std::size_t from = pixels_of(width, first);
  return batch_of(image.axis(), pixels_of(width, rows),
                  [&](std::size_t lane, std::size_t band) { return image.at(from + lane, band); });
}

/// The spectra as an array of structures.
inline std::vector<float> interleaved(const SampledSpectra& image) {
  std::vector<float> out;
  for (std::size_t lane = 0; lane < image.lanes(); ++lane) {
    for (std::size_t k = 0; k < image.axis().count(); ++k) out.push_back(image.at(lane, k));
  }
  return out;
}

inline Result<ImageReport> write_image(const std::string& path, const SampledSpectra& spectra, int width,
                                       int height, const SpectralImageOptions& options = kSpectralImage,
                                       std::span<const float> alpha = {}) {
  auto report = write_spectral_image(path, spectra, width, height, options, alpha);
  EXPECT_TRUE(report) << report.error().message;
  return report;
}

/// The samples that the library's own reader finds at the centres.
inline SampledSpectra read_spectra(const std::string& path) {
  const auto texture = SpectralTexture::open(path);
  if (!texture) {
    ADD_FAILURE() << texture.error().message;
    return {};
  }
  const PixelWindow all = {0, 0, texture->width(), texture->height()};
  auto out = *SampledSpectra::create(texture->bands(), pixels_of(all.width(), all.height()));
  const auto read = texture->evaluate(all, out.span());
  EXPECT_TRUE(read) << read.error().message;
  return out;
}

}  // namespace spectile::test
