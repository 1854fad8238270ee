// Fuzzes what reads an EXR file: info, settings, RGB into memory, spectral textures, the check of kernels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <spectile/image/convert.hpp>
#include <spectile/image/settings.hpp>
#include <spectile/image/spectral_texture.hpp>

#include "fuzz/exr_size.hpp"
#include "fuzz/support.hpp"

namespace {

using namespace spectile;

void inspect(const std::string& path) {
  const auto info = inspect_image(path, std::array<int, 2>{0, 0}, 1);
  if (!fuzz::is_value(info)) return;
  fuzz::require(info->width > 0 && info->height > 0, "an image has pixels");
  fuzz::require(info->quantity.has_value() == info->bands.has_value(),
                "a spectral image has quantity and bands");
  fuzz::require(!info->bands || info->bands->count() <= info->channels.size(), "a band is a channel");
  std::uint64_t nonfinite = 0;
  for (const ChannelInfo& channel : info->channels) {
    nonfinite += channel.nonfinite;
    fuzz::require(!(channel.minimum > channel.maximum), "a channel's range is in order", channel.name);
  }
  fuzz::require(info->nonfinite == nonfinite, "counts of channels sum up");
  fuzz::require(info->pixel.size() == (info->bands ? info->bands->count() : info->channels.size()),
                "the pixel asked for has a value a band or channel");
}

/// The same lookups through a cache of one tile and one of all.
void lookups(const std::string& path) {
  constexpr std::size_t kLanes = 70;
  auto u = ScalarLanes::create(kLanes);
  auto v = ScalarLanes::create(kLanes);
  const auto axis = SpectralAxis::own_wavelengths(2);
  if (!u || !v || !axis) return;
  auto lambda = SampledSpectra::create(*axis, kLanes);
  auto first = SampledSpectra::create(*axis, kLanes);
  auto second = SampledSpectra::create(*axis, kLanes);
  if (!lambda || !first || !second) return;
  for (std::size_t i = 0; i < kLanes; ++i) {
    (*u)[i] = static_cast<float>(i * 37 % 101) / 50 - 0.5F;
    (*v)[i] = static_cast<float>(i * 53 % 97) / 48 - 0.5F;
    for (std::size_t k = 0; k < 2; ++k) lambda->at(i, k) = static_cast<float>(380 + 6 * i + 3 * k);
  }
  const TexturePoints at = {.u = *u, .v = *v, .level = *v};
  for (auto* const samples : {&*first, &*second}) {
    const auto cache = TextureCache::create(samples == &*first ? 0 : TextureCache::kDefaultBytes);
    if (!cache) return;
    const auto texture = SpectralTexture::open(path, TextureOptions{.threads = 1, .cache = *cache});
    if (!fuzz::is_value(texture) || !fuzz::is_value(texture->sample(at, *lambda, *samples, {}, {1}))) return;
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const float a = first->at(i, k);
      const float b = second->at(i, k);
      fuzz::require(a == b || (std::isnan(a) && std::isnan(b)), "a sample does not depend on the cache");
    }
  }
}

void texture(const std::string& path) {
  const auto opened = SpectralTexture::open(path, 1);
  if (!fuzz::is_value(opened)) return;
  const auto centres = opened->bands().list();
  const double first = centres.front().centre_nm;
  const double last = centres.back().centre_nm;
  std::vector<double> nm = {first / 2, first, 0.5 * (first + last), last, 2 * last};
  nm.erase(std::unique(nm.begin(), nm.end()), nm.end());
  const PixelWindow corner = {0, opened->height() - 1, opened->width(), opened->height()};
  const auto once = opened->evaluate(corner, nm);
  if (!fuzz::is_value(once)) return;
  fuzz::require(once->lanes() == static_cast<std::size_t>(opened->width()), "a region has a lane a pixel");
  const auto alone = opened->evaluate(corner, std::vector<double>{first});
  fuzz::require(static_cast<bool>(alone), "what was read can be read again");
  const auto at = static_cast<std::size_t>(std::ranges::find(nm, first) - nm.begin());
  for (std::size_t lane = 0; lane < once->lanes(); ++lane) {
    const float a = once->at(lane, at);
    const float b = alone->at(lane, 0);
    fuzz::require(a == b || (std::isnan(a) && std::isnan(b)), "a wavelength's sample is its own affair",
                  fmt::format("lane {}: {} and {}", lane, a, b));
  }
}

void rgb(const std::string& path) {
  const auto image = read_rgb_image(path, {}, 1);
  if (!fuzz::is_value(image)) return;
  fuzz::require(
      image->rgb.lanes() == static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height),
      "an image has a lane a pixel");
}

void verify(const std::string& path) {
  MethodOptions options;
  options.threads = 1;
  const auto report = verify_image(path, options);
  if (!fuzz::is_value(report)) return;
  fuzz::require(
      report->ok(), "kernels give the reference's bits, and those are near the oracle's numbers",
      fmt::format("{}: {} of {} samples differ; oracle {} of {}", report->what, report->different_samples,
                  report->samples, report->max_oracle_difference, report->oracle_bound));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::Bytes bytes(data, size);
  const fuzz::CaseFolder folder(bytes);
  fuzz::is_value(settings_of(folder.input()));
  if (fuzz::is_small_image(bytes)) {
    inspect(folder.input());
    rgb(folder.input());
    texture(folder.input());
    lookups(folder.input());
    fuzz::is_value(validate_image(folder.input(), 1));
    // Takes several times as long as the others together.
    if (fuzz::Choices(bytes).one_in(4)) verify(folder.input());
  }
  folder.require_tidy(false);
  return 0;
}
