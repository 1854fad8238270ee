// Atlas: the colours of a scene's surfaces in one texture.
#pragma once

#include <filesystem>
#include <memory>
#include <spectile/spectile.hpp>

#include "scene.hpp"

namespace tracer {

using namespace spectile;

/// Surfaces side by side in a texture of coefficients, in the scene's order.
class Atlas {
 public:
  /// Paints the surfaces and upsamples them for bands.
  static Result<Atlas> create(const Scene& scene, const Bands& bands);
  /// Where u, v of a surface are in the texture.
  std::array<float, 2> point(std::size_t surface, double u, double v) const noexcept;
  const SpectralTexture& texture() const noexcept { return texture_; }

 private:
  using Folder = std::shared_ptr<const std::filesystem::path>;
  struct Column {
    std::size_t first = 0, texels = 0;  ///< texels without the margins; the first is the left margin
  };
  Atlas(Folder folder, SpectralTexture texture, std::vector<Column> columns)
      : folder_(std::move(folder)), texture_(std::move(texture)), columns_(std::move(columns)) {}
  static Result<Folder> make_temporary_folder();

  Folder folder_;  ///< of the texture's file, which it goes on to read; removed with its last owner
  SpectralTexture texture_;
  std::vector<Column> columns_;
};

}  // namespace tracer
