// Spectral images from one naming of channels, list of bands or unit to another, and a check of the layout.
#pragma once

#include <optional>
#include <spectile/image/image.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <string>
#include <vector>

namespace spectile {

/// Options of convert_image().
struct ConvertImageOptions : ImageOptions {
  /// Spectral channels keep their sample type, integers becoming floats; false: they become `pixel`.
  bool keep_depth = true;
  std::optional<Quantity> quantity;  ///< which to take where a file holds both, or does not say; else both
  std::string dialect = "layout";    ///< names of the output's channels; see spectral_dialects()
  /// Bands of the output; the input's where none. A new band's sample is the average over it of the input's
  /// samples, each taken as constant over its band. Where the input has no band, reflectances keep the value
  /// of the nearest band, and light is 0.
  std::optional<Bands> bands;
  double scale = 1;   ///< by which every spectral sample is multiplied
  std::string units;  ///< of the result's emission; where empty those that the input states
};

/// Names of the dialects that convert_image() writes, the layout first.
std::vector<std::string> spectral_dialects();

/// Turns a spectral image of any dialect into one of the layout, or of another dialect: reflectances with
/// re-radiation, emission with Stokes components, all of one layer and view; R, G, B, alpha, other channels
/// and attributes that still hold pass through.
///
/// Samples: without new bands, scale and depth every one keeps its bits. Negative ones, and zeros of either
/// sign, are kept. Products and averages beyond the range of float are infinite, and NaN and infinities, of
/// the input or made so, are an error or make the spectra of their pixel 0 (ImageOptions::nonfinite). Those
/// beyond the range of half, where halves are written, become the largest half, and their pixels are counted.
/// Errors: kBadArgument too, for a dialect that cannot hold what there is, a scale that is not positive and
/// within the range of float, units without emission, and for new bands of re-radiation and of planned bands.
Result<ImageReport> convert_image(const std::string& input, const std::string& output,
                                  const ConvertImageOptions& options = {});

/// A rule of the layout, and what in a file breaks it; or, as a remark, what is unusual about it.
struct LayoutFinding {
  std::string rule;    ///< a short name, such as "stokes"
  std::string detail;  ///< one line; of files with several parts it begins with the part
  bool remark = false;
};

/// Compares a file with the rules of the layout. Every spectral sample is read. An empty list: it follows
/// all of them, and nothing is unusual.
/// Source: Fichet, Pacanowski, Wilkie, An OpenEXR Layout for Spectral Images, JCGT 10(3), 2021, and its
/// authors' reader and writer. Errors: kBadFile for a file that cannot be read, kNoPermission.
Result<std::vector<LayoutFinding>> validate_image(const std::string& path, int threads = 0);

}  // namespace spectile
