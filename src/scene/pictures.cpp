// Contents of the procedural scenes.
#include <array>
#include <cmath>
#include <spectile/color/sensor.hpp>
#include <spectile/spectra/named_spectra.hpp>
#include <string>

#include "src/scene/layout.hpp"

namespace spectile::scene {
namespace {

/// Collects spectra, each scaled to luminance 1, and rectangles.
class Painter {
 public:
  /// A table at every nanometre of a product of two spectra.
  std::size_t add(const Spectrum& light, const Spectrum& reflectance = ConstantSpectrum(1)) {
    std::vector<double> values;
    constexpr auto kFirst = static_cast<int>(kFirstVisibleNm);
    constexpr auto kLast = static_cast<int>(kLastVisibleNm);
    for (int nm = kFirst; nm <= kLast; ++nm) values.push_back(light(nm) * reflectance(nm));
    static const Sensor observer = *Sensor::named("cie1931");
    const auto table = *DenselySampledSpectrum::from_values(kFirst, values);
    const double y = observer.factors()[1] * inner_product(observer.curves()[1], table);
    // The far tails of lines, which float would keep as denormals or not at all.
    constexpr double kNothing = 1e-15;
    for (double& v : values) v = v / y < kNothing ? 0 : v / y;
    picture_.spectra.push_back(*DenselySampledSpectrum::from_values(kFirst, std::move(values)));
    return picture_.spectra.size() - 1;
  }
  std::size_t add(const char* light) { return add(*named_spectrum(light)); }
  std::size_t add(const char* light, const char* reflectance) {
    return add(*named_spectrum(light), *named_spectrum(reflectance));
  }
  std::size_t add_lines(std::vector<GaussianSumSpectrum::Lobe> lines) {
    return add(*GaussianSumSpectrum::from_lobes(std::move(lines)));
  }

  struct Area {
    double x0, x1, y0, y1;
  };
  /// The same everywhere.
  void flat(const Area& a, std::size_t spectrum, double luminance) {
    picture_.rectangles.push_back({a.x0, a.x1, a.y0, a.y1, luminance, {}, {}, spectrum});
  }
  /// From `left` to `right` along x, times from `top` to `bottom` along y.
  void ramp(const Area& a, std::size_t spectrum, std::array<double, 2> left_right,
            std::array<double, 2> top_bottom) {
    const auto through = [](double t0, double t1, const std::array<double, 2>& v) {
      const double slope = (v[1] - v[0]) / (t1 - t0);
      return Linear{v[0] - slope * t0, slope};
    };
    picture_.rectangles.push_back({a.x0, a.x1, a.y0, a.y1, 1, through(a.x0, a.x1, left_right),
                                   through(a.y0, a.y1, top_bottom), spectrum});
  }

  /// Another picture at half its size, moved.
  void add_half(const Picture& other, double x, double y) {
    const std::size_t spectra = picture_.spectra.size();
    picture_.spectra.insert(picture_.spectra.end(), other.spectra.begin(), other.spectra.end());
    const auto moved = [](const Linear& f, double by) {
      return Linear{f.at0 - 2 * by * f.slope, 2 * f.slope};
    };
    for (const Rectangle& r : other.rectangles) {
      picture_.rectangles.push_back({x + r.x0 / 2, x + r.x1 / 2, y + r.y0 / 2, y + r.y1 / 2, r.scale,
                                     moved(r.along_x, x), moved(r.along_y, y), spectra + r.spectrum});
    }
  }

  Picture take() { return std::move(picture_); }

 private:
  Picture picture_;
};

/// Smooth ramps under daylight and lamplight, down to 0 and up to twice white.
Picture gradients() {
  Painter p;
  const auto d65 = p.add("D65");
  const auto a = p.add("A");
  const auto foliage = p.add("D65", "colorchecker-foliage");
  const auto orange = p.add("D50", "colorchecker-orange");
  const auto blue = p.add("D75", "colorchecker-blue-sky");
  const auto planck = p.add("blackbody:3200");
  p.ramp({0, 0.5, 0, 0.375}, d65, {0, 2}, {1, 1});
  p.ramp({0.5, 1, 0, 0.375}, a, {1, 0.25}, {0.125, 1});
  p.ramp({0, 0.625, 0.375, 0.75}, foliage, {0.5, 1}, {1, 0});
  p.ramp({0.625, 1, 0.375, 0.75}, orange, {1, 1}, {0.25, 1.5});
  p.ramp({0, 0.3, 0.75, 1}, blue, {1, 0}, {0, 1});
  p.ramp({0.3, 1, 0.75, 1}, planck, {0.1, 1}, {1, 0.5});
  return p.take();
}

/// Hard edges at places that are whole in no film, bright beside black, bars finer than pixels.
Picture edges() {
  Painter p;
  const auto d65 = p.add("D65");
  const auto a = p.add("A");
  const auto red = p.add("D65", "colorchecker-red");
  const auto green = p.add("D65", "colorchecker-green");
  p.flat({0.0703, 0.6127, 0.0907, 0.5241}, d65, 1);
  p.flat({0.3011, 0.8219, 0.2713, 0.4419}, a, 100);
  p.flat({0.3517, 0.4723, 0.1509, 0.6013}, red, 0.01);
  p.flat({0.6607, 0.9301, 0.0511, 0.2203}, green, 0.2);
  p.ramp({0.7013, 0.8807, 0.0719, 0.1931}, d65, {0.5, 3}, {1, 0.1});
  // A fan of bars, each a golden section narrower than the last.
  constexpr double kGolden = 0.6180339887498949;  // (sqrt(5) - 1) / 2
  double width = 0.0653;
  double x = 0.0509;
  for (int bar = 0; bar < 12; ++bar) {
    p.flat({x, x + width, 0.6637, 0.9411}, bar % 2 == 0 ? d65 : green, bar % 3 == 0 ? 30 : 1);
    x += 2.1 * width;
    width *= kGolden;
  }
  // Black over bright: a hole with four corners.
  p.flat({0.5303, 0.9107, 0.6101, 0.9703}, a, 10);
  p.flat({0.6011, 0.8303, 0.7019, 0.9007}, a, 0);
  p.flat({0.7129, 0.7307, 0.7993, 0.8111}, red, 40);
  return p.take();
}

/// Spectra with lines: lamps, LEDs, lasers, from even to steep in brightness.
Picture spikes() {
  Painter p;
  // Lines of mercury, sodium and common lasers. Source: NIST Atomic Spectra Database, in air; widths are
  // chosen.
  const std::size_t spectra[] = {
      p.add("FL11"),
      p.add("HP1"),
      p.add("LED-B1"),
      p.add("LED-RGB1"),
      p.add("FL2"),
      p.add_lines(
          {{0.6, 404.66, 1.2, 1.2}, {1, 435.83, 1.2, 1.2}, {1.2, 546.07, 1.2, 1.2}, {0.7, 578, 2, 2}}),
      p.add_lines({{1, 588.995, 1, 1}, {0.5, 589.592, 1, 1}}),
      p.add_lines({{1, 488, 1, 1}, {1, 532, 1, 1}, {1, 632.8, 1, 1}}),
      p.add_lines({{1, 452, 9, 14}, {0.4, 560, 45, 70}})};
  for (std::size_t i = 0; i < std::size(spectra); ++i) {
    const auto x = static_cast<double>(i % 3);
    const std::size_t row = i / 3;
    const auto y = static_cast<double>(row);
    const double steep = i % 2 == 0 ? 1 : 0.2;
    p.ramp({x / 3, (x + 1) / 3, y / 3, (y + 1) / 3}, spectra[i], {steep, 1}, {1, 1.5 - 0.5 * steep});
  }
  return p.take();
}

/// Ten steps of luminance from 1e-6 to 1e3, upwards and, below black, downwards.
Picture decades() {
  Painter p;
  const auto d65 = p.add("D65");
  const auto fl11 = p.add("FL11");
  constexpr int kSteps = 10;
  for (int step = 0; step < kSteps; ++step) {
    const double x0 = static_cast<double>(step) / kSteps;
    const double x1 = static_cast<double>(step + 1) / kSteps;
    p.flat({x0, x1, 0, 0.45}, d65, std::pow(10.0, step - 6));
    p.flat({x0, x1, 0.55, 1}, fl11, std::pow(10.0, 3 - step));
  }
  return p.take();
}

Picture mixed() {
  Painter p;
  p.add_half(gradients(), 0, 0);
  p.add_half(edges(), 0.5, 0);
  p.add_half(spikes(), 0, 0.5);
  p.add_half(decades(), 0.5, 0.5);
  return p.take();
}

struct Named {
  const char* name;
  Picture (*make)();
};

constexpr std::array kPictures = {Named{"gradients", gradients}, Named{"edges", edges},
                                  Named{"spikes", spikes}, Named{"decades", decades}, Named{"mixed", mixed}};

}  // namespace

std::vector<std::string> picture_names() {
  std::vector<std::string> out;
  for (const Named& n : kPictures) out.emplace_back(n.name);
  return out;
}

Picture picture(std::size_t which) {
  return kPictures[which].make();
}

}  // namespace spectile::scene
