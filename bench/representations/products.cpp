// Representations whose products are taken one coefficient at a time: RGB, sharpened RGB and bands.
#include <spectile/color/colorimetry.hpp>
#include <spectile/color/rgb_space.hpp>

#include "bench/representations/path_lanes.hpp"
#include "src/base/errors.hpp"
#include "src/spectra/band_weights.hpp"

namespace spectile::measure {
namespace {

struct ProductLanes {
  FloatBuffer bounces[kMaxBounces];
  FloatBuffer product;
  ColorOutput output;

  void follow(const kernels::KernelTable& table, std::size_t of) {
    output.project(table, multiply_bounces(table, bounces, of, product, kPaths * output.count));
  }
};

/// Primaries of sharpened RGB: rows that take XYZ to them. Source: Finlayson and Susstrunk, Spectral
/// Sharpening and the Bradford Transform, Color Imaging 2000.
constexpr Matrix3 kXyzToSharp = {1.2694, -0.0988, -0.1706, -0.8364, 1.8006, 0.0357, 0.0297, -0.0315, 1.0018};

}  // namespace

Result<Representation> multiplied(const PathScene& scene, std::string name, std::string source,
                                  const Products& products) {
  auto lanes = std::make_shared<ProductLanes>();
  for (std::size_t bounce = 0; bounce < kMaxBounces; ++bounce) {
    SPECTILE_ASSIGN(lanes->bounces[bounce], bounce_lanes(scene, products.reflectances, bounce));
  }
  SPECTILE_ASSIGN(lanes->output, ColorOutput::create(products.weights));
  SPECTILE_ASSIGN(lanes->product, FloatBuffer::create(kPaths * lanes->output.count));
  Representation out = follow_lanes(scene, lanes, lanes->output.count);
  out.name = std::move(name);
  out.source = std::move(source);
  return out;
}

Products rgb_products(const PathScene& scene, const Xyz& d65_white) {
  Products out;
  const Matrix3 to_xyz = rgb_to_xyz(kRec709, d65_white);
  const Xyz light = times(inverse(to_xyz), scene.light().white);
  for (std::size_t c = 0; c < 3; ++c) {
    out.weights.push_back({to_xyz[c] * light[c], to_xyz[3 + c] * light[c], to_xyz[6 + c] * light[c]});
  }
  for (const auto& c : scene.colors) out.reflectances.push_back({c[0], c[1], c[2]});
  return out;
}

Products sharpened_products(const PathScene& scene) {
  Products out;
  const Xyz white = times(kXyzToSharp, scene.light().white);
  const Matrix3 to_xyz = inverse(kXyzToSharp);
  for (std::size_t c = 0; c < 3; ++c) {
    out.weights.push_back({to_xyz[c] * white[c], to_xyz[3 + c] * white[c], to_xyz[6 + c] * white[c]});
  }
  for (const ReferenceReflectance& r : scene.reflectances()) {
    const Xyz sharp = times(kXyzToSharp, reference_xyz(scene.light(), {&r}));
    out.reflectances.push_back({sharp[0] / white[0], sharp[1] / white[1], sharp[2] / white[2]});
  }
  return out;
}

Result<Products> band_products(const PathScene& scene, const Bands& bands) {
  SPECTILE_ASSIGN(const auto under, Projector::reflective(bands, scene.light().spectrum));
  Products out;
  out.weights.assign(under.weights().begin(), under.weights().end());
  for (const ReferenceReflectance& r : scene.reflectances()) {
    std::vector<double>& samples = out.reflectances.emplace_back();
    for (std::size_t b = 0; b < bands.count(); ++b) samples.push_back(sample_in(r.spectrum, bands, b));
  }
  return out;
}

}  // namespace spectile::measure
