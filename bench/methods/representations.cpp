// Representations of light and materials side by side, in scenes of some bounces.
#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <spectile/upsampling/upsample.hpp>

#include "bench/methods/methods.hpp"
#include "src/base/errors.hpp"
#include "src/spectra/band_weights.hpp"

namespace spectile::measure {
namespace {

constexpr int kMaxBounces = 5;
/// Paths that errors are over; lane i is of path i modulo their number.
constexpr std::size_t kPaths = 512;

/// Coefficients of the reflectances and the projection from products of them to XYZ.
struct Representation {
  std::string name;
  std::size_t count = 0;
  std::vector<std::vector<float>> reflectances;  ///< [reflectance][count]
  std::vector<std::array<double, 3>> weights;    ///< [count], the light's included; its white has Y = 1
};

Representation on_bands(std::string name, const Bands& bands, const MethodScene& scene,
                        const Projector& under) {
  Representation out{std::move(name), bands.count(), {}, {}};
  for (const ReferenceReflectance& r : *scene.reflectances) {
    std::vector<float> samples;
    for (std::size_t b = 0; b < bands.count(); ++b) {
      samples.push_back(static_cast<float>(sample_in(r.spectrum, bands, b)));
    }
    out.reflectances.push_back(std::move(samples));
  }
  out.weights.assign(under.weights().begin(), under.weights().end());
  return out;
}

/// Linear sRGB under D65 of each reflectance.
Result<std::vector<std::array<float, 3>>> path_colors(const MethodScene& scene) {
  SPECTILE_ASSIGN(auto d65, reference_light("D65"));
  const Matrix3 matrix = inverse(rgb_to_xyz(kRec709, d65.white));
  std::vector<std::array<float, 3>> out;
  for (const ReferenceReflectance& r : *scene.reflectances) {
    const Xyz rgb = times(matrix, reference_xyz(d65, {&r}));
    out.push_back({static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
  }
  return out;
}

Result<std::vector<Representation>> representations_for(const MethodScene& scene) {
  std::vector<Representation> out;
  SPECTILE_ASSIGN(const auto colors, path_colors(scene));
  SPECTILE_ASSIGN(auto d65, reference_light("D65"));
  Representation rgb{"RGB", 3, {}, {}};
  const Matrix3 to_xyz = rgb_to_xyz(kRec709, d65.white);
  const Xyz light = times(inverse(to_xyz), scene.light->white);
  for (std::size_t c = 0; c < 3; ++c) {
    rgb.weights.push_back({to_xyz[c] * light[c], to_xyz[3 + c] * light[c], to_xyz[6 + c] * light[c]});
  }
  for (const auto& c : colors) rgb.reflectances.push_back({c[0], c[1], c[2]});
  out.push_back(std::move(rgb));

  std::vector<std::pair<std::string, Bands>> lists;
  for (const char* text : {"400:700:10", "400:700:5"}) {
    SPECTILE_ASSIGN(auto bands, Bands::parse(text));
    lists.emplace_back(fmt::format("{} even bands", bands.count()), bands);
  }
  for (const Bands& bands : scene.planned) {
    lists.emplace_back(fmt::format("{} planned bands", bands.count()), bands);
  }
  for (const auto& [name, bands] : lists) {
    SPECTILE_ASSIGN(auto under, Projector::reflective(bands, scene.light->spectrum));
    out.push_back(on_bands(name, bands, scene, under));
  }

  // A renderer that is given RGB has the spectra of sigmoids.
  const Bands bands;
  SPECTILE_ASSIGN(auto under, Projector::reflective(bands, scene.light->spectrum));
  SPECTILE_ASSIGN(auto upsampler, Upsampler::create(Method::kSigmoid, Quantity::kReflectance, bands));
  SPECTILE_ASSIGN(auto lanes, ColorLanes::create(colors.size()));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) lanes.at(i, k) = std::clamp(colors[i][k], 0.0F, 1.0F);
  }
  SPECTILE_ASSIGN(auto spectra, SampledSpectra::create(bands, colors.size()));
  SPECTILE_TRY(upsample_srgb(upsampler, lanes.view(), spectra.span()));
  Representation sigmoids{"sigmoids of RGB, 60 bands", bands.count(), {}, {}};
  for (std::size_t i = 0; i < colors.size(); ++i) {
    std::vector<float> samples;
    for (std::size_t b = 0; b < bands.count(); ++b) samples.push_back(spectra.at(i, b));
    sigmoids.reflectances.push_back(std::move(samples));
  }
  sigmoids.weights.assign(under.weights().begin(), under.weights().end());
  out.push_back(std::move(sigmoids));
  return out;
}

/// Lanes of one representation for each bounce, and their product's colour.
struct Lanes {
  FloatBuffer bounces[kMaxBounces];
  FloatBuffer product, xyz, weights;
  std::size_t count = 0;
};

Result<std::shared_ptr<Lanes>> representation_lanes(const Representation& r,
                                                    const std::vector<std::vector<std::size_t>>& paths) {
  auto out = std::make_shared<Lanes>();
  out->count = r.count;
  for (std::size_t bounce = 0; bounce < kMaxBounces; ++bounce) {
    SPECTILE_ASSIGN(out->bounces[bounce], FloatBuffer::create(kMethodLanes * r.count));
    for (std::size_t lane = 0; lane < kMethodLanes; ++lane) {
      const std::vector<float>& samples = r.reflectances[paths[lane % kPaths][bounce]];
      for (std::size_t b = 0; b < r.count; ++b) {
        out->bounces[bounce]
            .data()[(lane / kLanesPerBlock * r.count + b) * kLanesPerBlock + lane % kLanesPerBlock] =
            samples[b];
      }
    }
  }
  SPECTILE_ASSIGN(out->product, FloatBuffer::create(kMethodLanes * r.count));
  SPECTILE_ASSIGN(out->xyz, FloatBuffer::create(3 * kMethodLanes));
  SPECTILE_ASSIGN(out->weights, FloatBuffer::create(4 * r.count));
  for (std::size_t b = 0; b < r.count; ++b) {
    for (std::size_t k = 0; k < 4; ++k) {
      out->weights.data()[4 * b + k] = k < 3 ? static_cast<float>(r.weights[b][k]) : 0.0F;
    }
  }
  return out;
}

void run_paths(const kernels::KernelTable& k, Lanes& lanes, int bounces) {
  const float* product = lanes.bounces[0].data();
  for (int bounce = 1; bounce < bounces; ++bounce) {
    k.multiply(lanes.product.data(), product, lanes.bounces[bounce].data(), kMethodLanes * lanes.count);
    product = lanes.product.data();
  }
  float* const x = lanes.xyz.data();
  float* const xyz[3] = {x, x + kMethodLanes, x + 2 * kMethodLanes};
  k.project(xyz, product, lanes.weights.data(), lanes.count, blocks_for(kMethodLanes));
}

}  // namespace

Result<std::vector<RepresentationSpeed>> measure_representations(const MethodScene& scene,
                                                                 const TimingBudget& timing) {
  SPECTILE_ASSIGN(const auto made, representations_for(scene));
  std::mt19937_64 random(scene.seed);
  std::vector<std::vector<std::size_t>> paths(kPaths);
  for (auto& path : paths) {
    for (int i = 0; i < kMaxBounces; ++i) path.push_back(random() % scene.reflectances->size());
  }
  std::vector<RepresentationSpeed> out;
  std::vector<std::shared_ptr<Lanes>> lanes;
  std::vector<Timed> timed;
  for (const Representation& r : made) {
    SPECTILE_ASSIGN(lanes.emplace_back(), representation_lanes(r, paths));
    for (int bounces = 1; bounces <= kMaxBounces; ++bounces) {
      timed.emplace_back().run = [table = scene.table, l = lanes.back(), bounces] {
        run_paths(*table, *l, bounces);
      };
    }
  }
  std::vector<Timed*> work;
  for (Timed& t : timed) work.push_back(&t);
  time_in_turn(work, timing);
  for (std::size_t i = 0; i < made.size(); ++i) {
    for (int bounces = 1; bounces <= kMaxBounces; ++bounces) {
      run_paths(*scene.table, *lanes[i], bounces);
      ErrorList errors(scene.light->white);
      for (std::size_t p = 0; p < kPaths; ++p) {
        std::vector<const ReferenceReflectance*> along;
        along.reserve(kMaxBounces);
        for (int b = 0; b < bounces; ++b)
          along.push_back(&(*scene.reflectances)[paths[p][static_cast<std::size_t>(b)]]);
        Xyz found{};
        for (std::size_t k = 0; k < 3; ++k)
          found[k] = static_cast<double>(lanes[i]->xyz.data()[k * kMethodLanes + p]);
        errors.add(reference_xyz(*scene.light, along), found);
      }
      const Timed& t = timed[i * kMaxBounces + static_cast<std::size_t>(bounces - 1)];
      out.push_back({scene.light->name, scene.light->line_spectrum, made[i].name,
                     static_cast<int>(made[i].count), bounces,
                     1e9 * t.seconds / static_cast<double>(kMethodLanes), t.spread, errors.summary()});
    }
  }
  return out;
}

}  // namespace spectile::measure
