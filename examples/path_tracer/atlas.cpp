// Painting of a scene's surfaces, and the files that make a texture of them.
#include "atlas.hpp"

#include <algorithm>
#include <random>

namespace tracer {
namespace {

constexpr std::size_t kTexels = 512;  ///< of a pattern along u and v
/// On each side, so that filters do not reach into the next surface.
constexpr std::size_t kMargins = 2;
constexpr std::size_t kHeight = kTexels + kMargins;

/// Centre of a texel from 0 to 1; margins are like the texels beside them.
double centre(std::size_t i, std::size_t texels) {
  return (static_cast<double>(std::clamp<std::size_t>(i, 1, texels)) - 0.5) / static_cast<double>(texels);
}

}  // namespace

Result<Atlas::Folder> Atlas::make_temporary_folder() {
  std::random_device random;
  std::error_code error;
  const auto parent = std::filesystem::temp_directory_path(error);
  while (!error) {
    const auto path = parent / ("spectile-" + std::to_string(random()));
    if (!std::filesystem::create_directory(path, error)) continue;
    return Folder(new std::filesystem::path(path), [](const std::filesystem::path* made) {
      std::error_code ignored;
      std::filesystem::remove_all(*made, ignored);
      delete made;
    });
  }
  return Error{ErrorCode::kNoPermission, "cannot make a temporary folder: " + error.message()};
}

Result<Atlas> Atlas::create(const Scene& scene, const Bands& bands) {
  std::vector<Column> columns;
  std::size_t width = 0;
  for (const Surface& surface : scene.surfaces) {
    columns.push_back({width, surface.pattern == Pattern::kPlain ? 1 : kTexels});
    width += columns.back().texels + kMargins;
  }
  SPECTILE_ASSIGN(auto rgb, ColorLanes::create(width * kHeight));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto [first, texels] = columns[i];
    for (std::size_t texel = 0; texel < (texels + kMargins) * kHeight; ++texel) {
      const std::size_t x = texel % (texels + kMargins);
      const std::size_t y = texel / (texels + kMargins);
      const Rgb color = albedo(scene.surfaces[i], centre(x, texels), centre(y, kTexels));
      for (std::size_t c = 0; c < 3; ++c) rgb.at(y * width + first + x, c) = color[c];
    }
  }
  SPECTILE_ASSIGN(auto folder, make_temporary_folder());
  const std::string painted = (*folder / "rgb.exr").string();
  const std::string upsampled = (*folder / "coefficients.exr").string();
  UpsampleImageOptions options;
  options.pixel = SampleType::kFloat;
  options.store = Store::kCoefficients;
  options.bands = bands;
  SPECTILE_TRY(write_rgb_image(painted, rgb, static_cast<int>(width), static_cast<int>(kHeight), options));
  SPECTILE_TRY(upsample_image(painted, upsampled, options));
  SPECTILE_ASSIGN(auto texture, SpectralTexture::open(upsampled));
  return Atlas(std::move(folder), std::move(texture), std::move(columns));
}

std::array<float, 2> Atlas::point(std::size_t surface, double u, double v) const noexcept {
  const auto [first, texels] = columns_[surface];
  const double x = static_cast<double>(first) + 1 + u * static_cast<double>(texels);
  return {static_cast<float>(x / texture_.width()),
          static_cast<float>((1 + v * static_cast<double>(kTexels)) / static_cast<double>(kHeight))};
}

}  // namespace tracer
