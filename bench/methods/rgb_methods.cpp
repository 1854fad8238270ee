// Ways from an RGB texture to its colour under a light.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/upsampling/relight.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "bench/baseline/aos_baseline.hpp"
#include "bench/methods/methods.hpp"
#include "src/base/errors.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile::measure {
namespace {

using kernels::KernelTable;

/// Common input of all methods under a light: linear sRGB of the reflectances under D65, limited to the cube.
struct Texture {
  ColorLanes rgb;
  std::vector<float> interleaved;
};

Result<std::shared_ptr<const Texture>> make_texture(const MethodScene& scene) {
  SPECTILE_ASSIGN(auto d65, reference_light("D65"));
  SPECTILE_ASSIGN(auto rgb, ColorLanes::create(kMethodLanes));
  auto out = std::make_shared<Texture>();
  out->interleaved.resize(3 * kMethodLanes);
  // White as the light itself has it, so that grey is grey.
  const Matrix3 matrix = inverse(rgb_to_xyz(kRec709, d65.white));
  for (std::size_t i = 0; i < kMethodLanes; ++i) {
    const auto& r = (*scene.reflectances)[i % scene.reflectances->size()];
    const Xyz color = times(matrix, reference_xyz(d65, {&r}));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<float>(std::clamp(color[k], 0.0, 1.0));
      rgb.at(i, k) = v;
      out->interleaved[3 * i + k] = v;
    }
  }
  out->rgb = std::move(rgb);
  return std::shared_ptr<const Texture>(std::move(out));
}

/// Buffers and tables of a method.
struct RgbState {
  std::shared_ptr<const Texture> texture;
  std::shared_ptr<const Upsampler> upsampler;
  std::optional<Projector> projector;
  std::optional<Relighter> relighter;
  FloatBuffer spectra, coefficients;
  std::vector<std::uint16_t> halves;
  std::vector<std::uint64_t> unsolved;
  ColorLanes xyz;
};

struct Maker {
  const MethodScene& scene;
  std::shared_ptr<const Texture> texture;
  std::vector<MethodRun>& methods;

  Result<std::shared_ptr<RgbState>> state_for(const std::shared_ptr<const Upsampler>& upsampler) const {
    auto s = std::make_shared<RgbState>();
    s->texture = texture;
    s->upsampler = upsampler;
    SPECTILE_ASSIGN(s->projector, Projector::reflective(upsampler->bands(), scene.light->spectrum));
    SPECTILE_ASSIGN(s->spectra, FloatBuffer::create(kMethodLanes * upsampler->bands().count()));
    SPECTILE_ASSIGN(s->coefficients, FloatBuffer::create(3 * kMethodLanes));
    s->halves.resize(s->spectra.size());
    s->unsolved.resize(blocks_for(kMethodLanes));
    SPECTILE_ASSIGN(s->xyz, ColorLanes::create(kMethodLanes));
    return s;
  }

  void add(const std::shared_ptr<RgbState>& s, std::string family, std::string name, std::uint64_t bytes,
           std::function<void(const KernelTable&, RgbState&)> work) {
    MethodRun& method =
        methods.emplace_back(std::move(family), std::move(name), s->upsampler->bands().count(), bytes);
    method.run = [s, work = std::move(work), table = scene.table] { work(*table, *s); };
    method.result = [s](std::size_t lane) {
      Xyz out{};
      for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<double>(s->xyz.at(lane, k));
      return out;
    };
  }
};

std::array<const float*, 3> rgb_rows(const RgbState& s) {
  const auto view = s.texture->rgb.view();
  return {view.c[0], view.c[1], view.c[2]};
}

void sum_up(const KernelTable& k, RgbState& s) {
  k.project(s.xyz.span().c, s.spectra.data(), ProjectorAccess::weights(*s.projector),
            s.upsampler->bands().count(), blocks_for(kMethodLanes));
}

void through_halves(const KernelTable& k, RgbState& s) {
  k.float_to_half(s.halves.data(), s.spectra.data(), s.spectra.size());
  k.half_to_float(s.spectra.data(), s.halves.data(), s.spectra.size());
}

void mix(const KernelTable& k, RgbState& s) {
  if (s.upsampler->method() == Method::kTetrahedral) {
    k.grid_blocks(s.spectra.data(), rows::grid_spectra(*s.upsampler, rgb_rows(s).data(), nullptr),
                  blocks_for(kMethodLanes), false);
    return;
  }
  k.smits_blocks(s.spectra.data(), rgb_rows(s).data(),
                 {UpsamplerAccess::table(*s.upsampler), s.upsampler->bands().count(), s.upsampler->lowest()},
                 blocks_for(kMethodLanes), false);
}

void solve(const KernelTable& k, RgbState& s) {
  float* const c[3] = {s.coefficients.data(), s.coefficients.data() + kMethodLanes,
                       s.coefficients.data() + 2 * kMethodLanes};
  k.sigmoid_solve(c, rgb_rows(s).data(), UpsamplerAccess::sigmoid(*s.upsampler)->table, s.unsolved.data(),
                  kMethodLanes);
}

kernels::SigmoidSpectra sigmoids(RgbState& s, const float* (&c)[3]) {
  for (std::size_t k = 0; k < 3; ++k) c[k] = s.coefficients.data() + k * kMethodLanes;
  const kernels::SigmoidTable& table = UpsamplerAccess::sigmoid(*s.upsampler)->table;
  return {c, nullptr, table.rows, s.upsampler->bands().count(), false, table.form};
}

void evaluate(const KernelTable& k, RgbState& s) {
  const float* c[3];
  k.sigmoid_blocks(s.spectra.data(), sigmoids(s, c), blocks_for(kMethodLanes), false);
}

void sum_sigmoid(const KernelTable& k, RgbState& s) {
  const float* c[3];
  k.sigmoid_project(s.xyz.span().c, sigmoids(s, c), ProjectorAccess::weights(*s.projector), kMethodLanes);
}

constexpr Matrix3 kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/// A method on some bands, in each of its executions.
Result<void> add_method(Maker& maker, Method method, const Bands& bands, const std::string& label) {
  auto made = Upsampler::create(method, Quantity::kReflectance, bands);
  // Bands on which a method cannot be exact are left out.
  if (!made) return {};
  const auto upsampler = std::make_shared<const Upsampler>(*std::move(made));
  SPECTILE_ASSIGN(const auto s, maker.state_for(upsampler));
  const std::string family(to_string(method));
  const auto samples = static_cast<std::uint64_t>(bands.count());
  const auto name = [&](const char* execution) {
    return fmt::format("{}, {}, {}", family, label, execution);
  };
  if (is_sigmoid(method)) {
    maker.add(s, family, name("spectra in float"), 4 * samples, [](const KernelTable& k, RgbState& t) {
      solve(k, t);
      evaluate(k, t);
      sum_up(k, t);
    });
    maker.add(s, family, name("fused"), 0, [](const KernelTable& k, RgbState& t) {
      solve(k, t);
      sum_sigmoid(k, t);
    });
    solve(*maker.scene.table, *s);
    maker.add(s, family, name("coefficients stored"), 12, sum_sigmoid);
    return {};
  }
  maker.add(s, family, name("spectra in float"), 4 * samples, [](const KernelTable& k, RgbState& t) {
    mix(k, t);
    sum_up(k, t);
  });
  if (method == Method::kTetrahedral) {
    SPECTILE_ASSIGN(s->relighter, Relighter::create(*s->upsampler, *s->projector, kIdentity));
    maker.add(s, family, name("fused"), 0, [](const KernelTable& k, RgbState& t) {
      k.grid_fold(t.xyz.span().c, rows::folded_spectra(*t.relighter, rgb_rows(t).data(), nullptr),
                  kMethodLanes);
    });
    return {};
  }
  maker.add(s, family, name("spectra in half"), 2 * samples, [](const KernelTable& k, RgbState& t) {
    mix(k, t);
    through_halves(k, t);
    sum_up(k, t);
  });
  SPECTILE_ASSIGN(s->relighter, Relighter::create(*s->upsampler, *s->projector, kIdentity));
  maker.add(s, family, name("fused"), 0, [](const KernelTable& k, RgbState& t) {
    k.smits_fold(t.xyz.span().c, rgb_rows(t).data(), RelighterAccess::table(*t.relighter), kMethodLanes);
  });
  return {};
}

/// Three numbers a colour and a light of three numbers.
Result<void> add_rgb(Maker& maker) {
  SPECTILE_ASSIGN(auto upsampler, Upsampler::create(Method::kSmits, Quantity::kReflectance, Bands()));
  SPECTILE_ASSIGN(auto state, maker.state_for(std::make_shared<const Upsampler>(std::move(upsampler))));
  // The light's RGB, and back to XYZ; D65 itself is 1, 1, 1.
  SPECTILE_ASSIGN(auto d65, reference_light("D65"));
  const Matrix3 to_xyz = rgb_to_xyz(kRec709, d65.white);
  const Xyz light = times(inverse(to_xyz), maker.scene.light->white);
  auto folded = std::make_shared<std::vector<float>>();
  for (std::size_t i = 0; i < 9; ++i) folded->push_back(static_cast<float>(to_xyz[i] * light[i % 3]));
  maker.add(state, "RGB", "RGB times RGB", 12, [folded](const KernelTable& k, RgbState& t) {
    k.transform3(t.xyz.span().c, rgb_rows(t).data(), folded->data(), kMethodLanes);
  });
  maker.methods.back().bands = 0;
  return {};
}

Result<void> add_aos_baseline(Maker& maker) {
  for (const AosJob& job : aos_baseline().jobs) {
    SPECTILE_ASSIGN(auto bands, Bands::uniform(400, 700, 300.0 / static_cast<double>(job.samples)));
    SPECTILE_ASSIGN(auto upsampler, Upsampler::create(Method::kSmits, Quantity::kReflectance, bands));
    SPECTILE_ASSIGN(auto observer, Projector::emissive(bands));
    struct Baseline {
      AosTables scene{};
      std::vector<float> xyz;
      std::shared_ptr<const Texture> texture;
    };
    auto baseline = std::make_shared<Baseline>();
    baseline->texture = maker.texture;
    baseline->xyz.resize(3 * kMethodLanes);
    const std::vector<float> light = maker.scene.light->spectrum.average_over(bands);
    double y = 0;
    for (std::size_t i = 0; i < job.samples; ++i)
      y += observer.weights()[i][1] * static_cast<double>(light[i]);
    for (std::size_t i = 0; i < job.samples; ++i) {
      for (std::size_t k = 0; k < 7; ++k)
        baseline->scene.basis[k][i] = static_cast<float>(upsampler.basis()[i][k]);
      for (std::size_t k = 0; k < 3; ++k) {
        baseline->scene.matching[k][i] = static_cast<float>(observer.weights()[i][k]);
      }
      baseline->scene.light[i] = static_cast<float>(static_cast<double>(light[i]) / y);
    }
    MethodRun& method = maker.methods.emplace_back(
        "AoS baseline", fmt::format("AoS baseline, smits, {} even bands", job.samples), job.samples, 0);
    method.run = [baseline, &job] {
      job.relight(baseline->scene, baseline->texture->interleaved.data(), baseline->xyz.data(), kMethodLanes);
    };
    method.result = [baseline](std::size_t lane) {
      return Xyz{static_cast<double>(baseline->xyz[3 * lane]),
                 static_cast<double>(baseline->xyz[3 * lane + 1]),
                 static_cast<double>(baseline->xyz[3 * lane + 2])};
    };
  }
  return {};
}

}  // namespace

Result<std::vector<MethodRun>> rgb_methods(const MethodScene& scene, bool quick) {
  SPECTILE_ASSIGN(auto texture, make_texture(scene));
  std::vector<MethodRun> methods;
  Maker maker{scene, texture, methods};
  SPECTILE_TRY(add_aos_baseline(maker));
  SPECTILE_TRY(add_rgb(maker));
  std::vector<std::pair<Bands, std::string>> lists;
  for (const char* text : {"400:700:18.75", "400:700:10", "400:700:5", "380:780:5"}) {
    if (quick && std::string_view(text) != "400:700:5") continue;
    SPECTILE_ASSIGN(auto bands, Bands::parse(text));
    lists.emplace_back(bands, fmt::format("{} even bands{}", bands.count(),
                                          bands.list().front().lower_nm < 400 ? " to 780 nm" : ""));
  }
  for (const Bands& bands : scene.planned) {
    lists.emplace_back(bands, fmt::format("{} planned bands", bands.count()));
  }
  for (const auto& [bands, label] : lists) {
    for (const Method method : {Method::kSmits, Method::kSmitsExact, Method::kMallett, Method::kSigmoid,
                                Method::kSigmoidObserver, Method::kTetrahedral}) {
      SPECTILE_TRY(add_method(maker, method, bands, label));
    }
  }
  return methods;
}

}  // namespace spectile::measure
