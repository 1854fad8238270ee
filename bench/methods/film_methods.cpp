// Ways from spectral samples to a film.
#include <fmt/format.h>

#include <optional>
#include <random>
#include <spectile/film/film.hpp>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "bench/baseline/aos_baseline.hpp"
#include "bench/methods/methods.hpp"
#include "src/base/errors.hpp"
#include "src/spectra/band_weights.hpp"

namespace spectile::measure {
namespace {

/// The film's width; a lane goes to the pixel of its number, so that samples come row by row.
constexpr int kWidth = 64;
constexpr int kHeight = static_cast<int>(kMethodLanes) / kWidth;
/// Samples of drawn wavelengths that a pixel is given.
constexpr std::size_t kDrawsPerPixel = 256;
constexpr std::size_t kWavelengths = 4;

struct Positions {
  std::vector<float> x, y;
  Positions() {
    for (std::size_t i = 0; i < kMethodLanes; ++i) {
      x.push_back(static_cast<float>(i % kWidth) + 0.5F);
      const std::size_t line = i / kWidth;
      y.push_back(static_cast<float>(line) + 0.5F);
    }
  }
};

/// A film and the samples that it is fed with.
struct FilmState {
  Positions at;
  std::vector<float> radiance;  ///< [band][lane]
  std::optional<Film> film;
  double white_y = 1;  ///< of the perfect diffuser, which the results are relative to
};

Result<FilmDevelopment> developed(const Film& film) {
  SPECTILE_ASSIGN(auto picture, FilmDevelopment::create(film, FilmLayer::kXyz));
  SPECTILE_TRY(picture.update({1}));
  return picture;
}

std::function<Xyz(std::size_t)> pixel_reader(const std::shared_ptr<FilmState>& s) {
  return [s, picture = std::shared_ptr<FilmDevelopment>()](std::size_t lane) mutable {
    if (picture == nullptr) {
      auto made = developed(*s->film);
      if (!made) return Xyz{};
      picture = std::make_shared<FilmDevelopment>(*std::move(made));
    }
    const int x = static_cast<int>(lane) % kWidth;
    const int y = static_cast<int>(lane) / kWidth;
    Xyz out{};
    for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<double>(picture->at(k, x, y)) / s->white_y;
    return out;
  };
}

FilmOptions film_options() {
  FilmOptions o;
  o.width = kWidth;
  o.height = kHeight;
  o.filter = *PixelFilter::box();
  return o;
}

/// Each lane's radiance in the bands: its reflectance's sample times the light's.
Result<std::vector<float>> radiance_on(const MethodScene& scene, const Bands& bands, double* white_y) {
  SPECTILE_ASSIGN(const auto light, light_samples(scene.light->spectrum, bands));
  SPECTILE_ASSIGN(auto observer, Projector::emissive(bands));
  *white_y = 0;
  for (std::size_t b = 0; b < bands.count(); ++b) *white_y += observer.weights()[b][1] * light[b];
  std::vector<float> out(bands.count() * kMethodLanes);
  for (std::size_t r = 0; r < scene.reflectances->size(); ++r) {
    for (std::size_t b = 0; b < bands.count(); ++b) {
      const double sample = sample_in((*scene.reflectances)[r].spectrum, bands, b);
      const auto value = static_cast<float>(sample * light[b]);
      for (std::size_t lane = r; lane < kMethodLanes; lane += scene.reflectances->size()) {
        out[b * kMethodLanes + lane] = value;
      }
    }
  }
  return out;
}

Result<void> add_bands(const MethodScene& scene, const Bands& bands, const std::string& family,
                       const std::string& name, std::vector<MethodRun>& methods) {
  auto s = std::make_shared<FilmState>();
  SPECTILE_ASSIGN(s->radiance, radiance_on(scene, bands, &s->white_y));
  FilmOptions o = film_options();
  o.input = FilmInput::kBands;
  o.bands = bands;
  SPECTILE_ASSIGN(s->film, Film::create(o));
  MethodRun& method = methods.emplace_back(family, name, bands.count(), bands.count() * sizeof(float));
  method.run = [s, n = bands.count()] {
    static_cast<void>(s->film->add(BandSamples{s->at.x, s->at.y, {}, {s->radiance.data(), n, kMethodLanes}}));
  };
  method.result = pixel_reader(s);
  return {};
}

Result<void> add_wavelengths(const MethodScene& scene, std::vector<MethodRun>& methods) {
  struct Drawn {
    FilmState film;
    std::vector<SampledWavelengths> draws;
    std::vector<SampledSpectra> radiance;
    std::size_t next = 0;
    void add(std::size_t draw) {
      static_cast<void>(film.film->add({film.at.x, film.at.y, {}}, radiance[draw], draws[draw]));
    }
  };
  auto d = std::make_shared<Drawn>();
  SPECTILE_ASSIGN(d->film.film, Film::create(film_options()));
  std::mt19937_64 random(scene.seed);
  SPECTILE_ASSIGN(auto u, ScalarLanes::create(kMethodLanes));
  // The light on the scale on which the film's white is 1.
  const auto& light = scene.light->spectrum;
  double luminance = 0;
  SPECTILE_ASSIGN(const auto y_bar, named_spectrum("cie1931-y"));
  double total = 0;
  for (int nm = 360; nm <= 830; ++nm) {
    luminance += y_bar(nm) * light.at(nm);
    total += y_bar(nm);
  }
  luminance /= total;
  for (std::size_t sample = 0; sample < kDrawsPerPixel; ++sample) {
    // Stratified over a pixel's samples: each in its own part of the range.
    for (std::size_t i = 0; i < kMethodLanes; ++i) {
      const double jitter = static_cast<double>(random() >> 11U) * 0x1p-53;
      u[i] = static_cast<float>((static_cast<double>(sample) + jitter) / static_cast<double>(kDrawsPerPixel));
    }
    SPECTILE_ASSIGN(auto drawn, SampledWavelengths::create(kMethodLanes, kWavelengths));
    SPECTILE_TRY(sample_wavelengths(WavelengthSampling::kVisible, u.view(), drawn));
    SPECTILE_ASSIGN(auto radiance, SampledSpectra::create(drawn.axis(), kMethodLanes));
    for (std::size_t i = 0; i < kMethodLanes; ++i) {
      const auto& r = (*scene.reflectances)[i % scene.reflectances->size()].spectrum;
      for (std::size_t k = 0; k < kWavelengths; ++k) {
        const auto nm = static_cast<double>(drawn.lambda_nm.at(i, k));
        radiance.at(i, k) = static_cast<float>(r.at(nm) * light.at(nm) / luminance);
      }
    }
    d->draws.push_back(std::move(drawn));
    d->radiance.push_back(std::move(radiance));
  }
  MethodRun& method = methods.emplace_back(
      "wavelengths", fmt::format("{} drawn wavelengths, {} samples a pixel", kWavelengths, kDrawsPerPixel), 0,
      kDrawsPerPixel * 3 * kWavelengths * sizeof(float));
  method.per_lane = static_cast<double>(kDrawsPerPixel);
  method.run = [d] {
    d->add(d->next);
    d->next = (d->next + 1) % kDrawsPerPixel;
  };
  // Evaluated in a film of its own, which each sample has reached once.
  method.result = [d, pixels = std::function<Xyz(std::size_t)>()](std::size_t lane) mutable {
    if (!pixels) {
      auto fresh = Film::create(film_options());
      if (!fresh) return Xyz{};
      d->film.film = *std::move(fresh);
      for (std::size_t i = 0; i < kDrawsPerPixel; ++i) {
        d->add(i);
      }
      pixels = pixel_reader(std::shared_ptr<FilmState>(d, &d->film));
    }
    return pixels(lane);
  };
  return {};
}

Result<void> add_aos_baseline(const MethodScene& scene, std::vector<MethodRun>& methods) {
  for (const AosJob& job : aos_baseline().jobs) {
    SPECTILE_ASSIGN(auto bands, Bands::uniform(400, 700, 300.0 / static_cast<double>(job.samples)));
    SPECTILE_ASSIGN(auto observer, Projector::emissive(bands));
    struct Baseline {
      AosTables scene{};
      std::vector<float> radiance, weight;
      std::vector<std::size_t> pixel;
      std::vector<AosPixel> film;
      double white_y = 1;
    };
    auto baseline = std::make_shared<Baseline>();
    SPECTILE_ASSIGN(const auto rows, radiance_on(scene, bands, &baseline->white_y));
    baseline->radiance.resize(kMethodLanes * job.samples);
    for (std::size_t i = 0; i < kMethodLanes; ++i) {
      for (std::size_t b = 0; b < job.samples; ++b)
        baseline->radiance[i * job.samples + b] = rows[b * kMethodLanes + i];
      baseline->pixel.push_back(i);
    }
    baseline->weight.assign(kMethodLanes, 1.0F);
    baseline->film.resize(kMethodLanes);
    for (std::size_t b = 0; b < job.samples; ++b) {
      for (std::size_t k = 0; k < 3; ++k) {
        baseline->scene.matching[k][b] = static_cast<float>(observer.weights()[b][k]);
      }
    }
    MethodRun& method =
        methods.emplace_back("AoS baseline", fmt::format("AoS baseline, {} even bands", job.samples),
                             job.samples, job.samples * sizeof(float));
    method.run = [baseline, &job] {
      job.add(baseline->scene, baseline->radiance.data(), baseline->weight.data(), baseline->pixel.data(),
              baseline->film.data(), kMethodLanes);
    };
    method.result = [baseline](std::size_t lane) {
      const AosPixel& p = baseline->film[lane];
      Xyz out{};
      for (std::size_t k = 0; k < 3; ++k) out[k] = p.xyz[k] / p.weight / baseline->white_y;
      return out;
    };
  }
  return {};
}

}  // namespace

Result<std::vector<MethodRun>> film_methods(const MethodScene& scene, bool quick) {
  std::vector<MethodRun> methods;
  SPECTILE_TRY(add_aos_baseline(scene, methods));
  for (const char* text : {"400:700:18.75", "400:700:10", "400:700:5", "380:780:5"}) {
    SPECTILE_ASSIGN(auto bands, Bands::parse(text));
    const bool wide = bands.list().front().lower_nm < 400;
    SPECTILE_TRY(add_bands(scene, bands, "even bands",
                           fmt::format("{} even bands{}", bands.count(), wide ? " to 780 nm" : ""), methods));
  }
  for (const Bands& bands : scene.planned) {
    SPECTILE_TRY(
        add_bands(scene, bands, "planned bands", fmt::format("{} planned bands", bands.count()), methods));
  }
  if (!quick) SPECTILE_TRY(add_wavelengths(scene, methods));
  return methods;
}

}  // namespace spectile::measure
