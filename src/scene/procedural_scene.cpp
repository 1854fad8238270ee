// ProceduralScene: by name, at a point, and the exact values of pixels.
#include <spectile/scene/procedural_scene.hpp>

#include "src/base/errors.hpp"
#include "src/scene/parts.hpp"

namespace spectile {
namespace {

using Triple = std::array<double, 3>;

Triple weighted_sum(const std::vector<double>& amounts, const std::vector<Triple>& responses) {
  Triple out{};
  for (std::size_t s = 0; s < amounts.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) out[c] += amounts[s] * responses[s][c];
  }
  return out;
}

}  // namespace

ProceduralScene::Parts::Parts(scene::Picture picture) : layout(std::move(picture)), responses(layout) {
  for (const DenselySampledSpectrum& spectrum : layout.spectra()) {
    const auto values = spectrum.values();
    for (std::size_t i = 0; i < kIntervals; ++i) {
      tables.push_back(static_cast<float>(values[i]));
      tables.push_back(static_cast<float>(values[i + 1] - values[i]));
    }
  }
}

Result<ProceduralScene> ProceduralScene::named(std::string_view name) {
  const std::vector<std::string> known = names();
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] == name) return ProceduralScene(std::make_shared<const Parts>(scene::picture(i)));
  }
  return make_error(ErrorCode::kUnknownName, "scene \"{}\" is unknown; there are {}", name.substr(0, 64),
                    fmt::join(known, ", "));
}

std::vector<std::string> ProceduralScene::names() {
  return scene::picture_names();
}

double ProceduralScene::radiance(double x, double y, double lambda_nm, int width, int height) const {
  // Times the inverse, as draw() does, so that both agree on which side of an edge a point is.
  const double u = x * (1.0 / width);
  const double v = y * (1.0 / height);
  const scene::Rectangle& r = parts_->layout.at(u, v);
  return r.factor(u, v) * parts_->layout.spectra()[r.spectrum](lambda_nm);
}

std::array<double, 3> ProceduralScene::xyz(const FilmOptions& film, int x, int y) const {
  return weighted_sum(scene::amounts(parts_->layout, film, x, y), *parts_->responses.xyz(film));
}

std::array<double, 3> ProceduralScene::sensor(const FilmOptions& film, std::size_t sensor, int x,
                                              int y) const {
  if (sensor >= film.sensors.size()) return {};
  return weighted_sum(scene::amounts(parts_->layout, film, x, y), *parts_->responses.sensor(film, sensor));
}

std::vector<double> ProceduralScene::spectrum(const FilmOptions& film, int x, int y) const {
  const std::vector<double> amounts = scene::amounts(parts_->layout, film, x, y);
  // Wavelengths beyond those drawn have no say in the mean of those that fell into a band.
  const auto averages = parts_->responses.averages(film.bands, film.input == FilmInput::kWavelengths);
  const std::size_t bands = film.bands.count();
  std::vector<double> out(bands);
  for (std::size_t s = 0; s < amounts.size(); ++s) {
    for (std::size_t b = 0; b < bands; ++b) out[b] += amounts[s] * averages->exact[s * bands + b];
  }
  return out;
}

}  // namespace spectile
