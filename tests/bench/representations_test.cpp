// Representations of light and materials: each against what its publication says, worked out another way.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "bench/representations/representation.hpp"
#include "src/dispatch/dispatch.hpp"

namespace spectile::test {
namespace {

using namespace measure;  // NOLINT(google-build-using-namespace): the subject of all tests here

/// The ColorChecker under a light, and paths.
struct Chart {
  explicit Chart(const char* name)
      : light(*reference_light(name)), reflectances(*reference_reflectances(*chart_reflectances())) {
    methods.reflectances = &reflectances;
    methods.light = &light;
    methods.table = *dispatch::find(dispatch::available().back()->name);
    paths = *path_scene(methods);
  }
  Chart(const Chart&) = delete;
  Chart& operator=(const Chart&) = delete;

  Xyz reference(std::size_t path, std::size_t bounces) const {
    std::vector<const ReferenceReflectance*> along;
    for (std::size_t b = 0; b < bounces; ++b) along.push_back(&reflectances[paths.paths[path][b]]);
    return reference_xyz(light, along);
  }
  ColorError error(const Representation& r, std::size_t bounces) const {
    const auto colors = r.colors(bounces);
    ErrorList list(light.white);
    for (std::size_t p = 0; p < kPaths; ++p) list.add(reference(p, bounces), colors[p]);
    return list.summary();
  }

  ReferenceLight light;
  std::vector<ReferenceReflectance> reflectances;
  MethodScene methods;
  PathScene paths;
};

TEST(Representations, OneBounceOfFilteredColorsIsExactAndRgbUnderItsOwnLightAlone) {
  for (const char* name : {"D65", "FL11"}) {
    const Chart chart(name);
    const auto sharp = *multiplied(chart.paths, "", "", sharpened_products(chart.paths));
    EXPECT_LT(chart.error(sharp, 1).maximum, 1e-3) << name;
    const auto rgb =
        *multiplied(chart.paths, "", "", rgb_products(chart.paths, reference_light("D65")->white));
    if (std::string_view(name) == "D65") {
      EXPECT_LT(chart.error(rgb, 1).maximum, 1e-3);
    } else {
      EXPECT_GT(chart.error(rgb, 1).mean, 1);
    }
    // Further bounces are the componentwise product of numbers in those primaries, by hand.
    const Products products = sharpened_products(chart.paths);
    const auto found = sharp.colors(3);
    for (const std::size_t path : {0, 77, 511}) {
      for (std::size_t k = 0; k < 3; ++k) {
        double expected = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          double product = products.weights[c][k];
          for (std::size_t b = 0; b < 3; ++b) product *= products.reflectances[chart.paths.paths[path][b]][c];
          expected += product;
        }
        EXPECT_NEAR(found[path][k], expected, 1e-6);
      }
    }
  }
}

TEST(Representations, TreesHalveWhatIsMostWrong) {
  const Chart chart("FL11");
  double last = 1e9;
  for (const std::size_t count : {2, 8, 16, 64}) {
    const auto leaves = tree_leaves(chart.paths, count);
    ASSERT_EQ(leaves.size(), count);
    std::size_t at = 0;
    for (const Interval& leaf : leaves) {
      EXPECT_EQ(leaf.first, at);
      // A power of two, but where the grid ends, and at a multiple of it.
      std::size_t width = 1;
      while (width < leaf.count) width *= 2;
      EXPECT_EQ(leaf.first % width, 0U);
      EXPECT_TRUE(leaf.count == width || leaf.first + leaf.count == kGridSamples);
      at += leaf.count;
    }
    EXPECT_EQ(at, kGridSamples);
    const Products products = tree_products(chart.paths, leaves);
    Xyz white{};
    for (const auto& w : products.weights) {
      for (std::size_t k = 0; k < 3; ++k) white[k] += w[k];
    }
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(white[k], chart.light.white[k], 1e-12);
    const double error = chart.error(*multiplied(chart.paths, "", "", products), 2).mean;
    EXPECT_LT(error, last) << count;
    last = error;
  }
  EXPECT_LT(last, 0.05);
}

TEST(Representations, SpikesAreTheLampsLinesAndNothingIsLost) {
  for (const char* name : {"A", "D65", "E", "FL2", "FL11", "HP1"}) {
    const Chart chart(name);
    const SmoothAndSpikes split = smooth_and_spikes(chart.light);
    Xyz sum{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < kGridSamples; ++i) sum[k] += split.smooth[i] * chart.light.weights[k][i];
      for (const Spike& spike : split.spikes) sum[k] += spike.xyz[k];
      EXPECT_NEAR(sum[k], chart.light.white[k], 1e-12) << name;
    }
    EXPECT_EQ(split.spikes.empty(), !chart.light.line_spectrum) << name;
  }
  // Mercury's blue line, and those of terbium and europium, within the table's 5 nm. Source: CIE 015's
  // FL11.
  const Chart chart("FL11");
  for (const double line : {436.0, 545.0, 611.0}) {
    bool found = false;
    for (const Spike& spike : smooth_and_spikes(chart.light).spikes) found |= std::abs(spike.nm - line) < 5;
    EXPECT_TRUE(found) << line;
  }
}

TEST(Representations, BasesAreCharacteristicVectorsAndProductsProjections) {
  const Chart chart("FL11");
  constexpr std::size_t kFunctions = 4;
  const LinearBasis basis = characteristic_basis(chart.paths, kFunctions);
  const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  for (std::size_t j = 0; j < kFunctions; ++j) {
    for (std::size_t k = 0; k <= j; ++k) {
      EXPECT_NEAR(dot(basis.functions[j], basis.functions[k]), j == k ? 1 : 0, 1e-12);
    }
  }
  // The covariance takes a function to the functions' span.
  auto lit = spectra_of_scene(chart.paths);
  for (auto& spectrum : lit) {
    for (std::size_t i = 0; i < kGridSamples; ++i) spectrum[i] *= basis.light[i];
  }
  const auto image_of = [&](const std::vector<double>& f) {
    std::vector<double> image(kGridSamples);
    for (const auto& spectrum : lit) {
      const double along = dot(spectrum, f);
      for (std::size_t i = 0; i < kGridSamples; ++i) image[i] += along * spectrum[i];
    }
    return image;
  };
  const auto leave_the_span = [&](std::vector<double>& f) {
    for (const auto& g : basis.functions) {
      const double along = dot(f, g);
      for (std::size_t i = 0; i < kGridSamples; ++i) f[i] -= along * g[i];
    }
  };
  double least = 1e300;
  for (const auto& f : basis.functions) {
    std::vector<double> image = image_of(f);
    least = std::min(least, dot(image, f));
    const double length = std::sqrt(dot(image, image));
    leave_the_span(image);
    EXPECT_LT(std::sqrt(dot(image, image)), 1e-6 * length);
  }
  // And to nowhere outside it as far: the largest of the rest, by repeated application.
  std::vector<double> rest(kGridSamples);
  for (std::size_t i = 0; i < kGridSamples; ++i) rest[i] = std::sin(0.37 * static_cast<double>(i * i % 101));
  double largest = 0;
  for (int i = 0; i < 100; ++i) {
    leave_the_span(rest);
    const double length = std::sqrt(dot(rest, rest));
    for (double& v : rest) v /= length;
    auto image = image_of(rest);
    largest = dot(image, rest);
    rest = std::move(image);
  }
  EXPECT_GT(largest, 0);
  EXPECT_LT(largest, least);
  // A path: lit, multiplied and projected onto the functions, bounce by bounce.
  const auto found = linear_basis(chart.paths, basis, kFunctions)->colors(3);
  for (const std::size_t path : {0, 100, 511}) {
    std::vector<double> spectrum = basis.light;
    for (std::size_t b = 0; b < 3; ++b) {
      std::vector<double> product(kGridSamples);
      for (std::size_t i = 0; i < kGridSamples; ++i) {
        product[i] = spectrum[i] * chart.reflectances[chart.paths.paths[path][b]].values[i];
      }
      std::fill(spectrum.begin(), spectrum.end(), 0.0);
      for (const auto& f : basis.functions) {
        const double along = dot(product, f);
        for (std::size_t i = 0; i < kGridSamples; ++i) spectrum[i] += along * f[i];
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      double expected = 0;
      for (std::size_t i = 0; i < kGridSamples; ++i) {
        if (basis.light[i] > 0) expected += spectrum[i] / basis.light[i] * chart.light.weights[k][i];
      }
      EXPECT_NEAR(found[path][k], expected, 2e-5) << path;
    }
  }
}

TEST(Representations, CubicsComeBack) {
  std::vector<double> spectrum(kGridSamples);
  for (std::size_t i = 0; i < kGridSamples; ++i) {
    const double x = (static_cast<double>(i) - 235) / 235;
    spectrum[i] = 0.3 + 0.2 * x - 0.1 * x * x + 0.15 * x * x * x;
  }
  const auto fit = chebyshev_fit(spectrum);
  ASSERT_EQ(fit.size(), 16U);
  // At some samples of each interval of 100 from 380 nm.
  for (std::size_t interval = 0; interval < 4; ++interval) {
    for (const std::size_t sample : {0, 31, 99}) {
      const double x = (2.0 * static_cast<double>(sample) + 1) / 100 - 1;
      double value = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        value += fit[4 * interval + k] * std::cos(static_cast<double>(k) * std::acos(x));
      }
      EXPECT_NEAR(value, spectrum[20 + 100 * interval + sample], 1e-12);
    }
  }
}

TEST(Representations, PolynomialsProductsAreTheProductsLowestTerms) {
  const Chart chart("FL11");
  const auto found = polynomials(chart.paths)->colors(2);
  for (const std::size_t path : {0, 300, 511}) {
    const auto a = chebyshev_fit(chart.reflectances[chart.paths.paths[path][0]].values);
    const auto b = chebyshev_fit(chart.reflectances[chart.paths.paths[path][1]].values);
    Xyz expected{};
    for (std::size_t interval = 0; interval < 4; ++interval) {
      const auto at = [&](const std::vector<double>& c, double angle) {
        double value = 0;
        for (std::size_t k = 0; k < 4; ++k)
          value += c[4 * interval + k] * std::cos(static_cast<double>(k) * angle);
        return value;
      };
      // The product's terms by the discrete cosine transform, then their sums with the light.
      double terms[4] = {};
      constexpr int kNodes = 8;
      for (int node = 0; node < kNodes; ++node) {
        const double angle = std::numbers::pi * (node + 0.5) / kNodes;
        for (int k = 0; k < 4; ++k) {
          terms[k] += at(a, angle) * at(b, angle) * std::cos(k * angle) * (k == 0 ? 1 : 2) / kNodes;
        }
      }
      for (std::size_t sample = 0; sample < 100; ++sample) {
        const double angle = std::acos((2.0 * static_cast<double>(sample) + 1) / 100 - 1);
        double value = 0;
        for (int k = 0; k < 4; ++k) value += terms[k] * std::cos(k * angle);
        for (std::size_t k = 0; k < 3; ++k) {
          expected[k] += value * chart.light.weights[k][20 + 100 * interval + sample];
        }
      }
    }
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[path][k], expected[k], 2e-6) << path;
  }
}

TEST(Representations, ErrorsUnderALampStayWhatTheyAre) {
  // Mean errors after one bounce and after five, half as much again as were found.
  const std::map<std::string, std::array<double, 2>> bounds = {
      {"RGB", {5.3, 1.7}},
      {"sharpened RGB", {0.001, 0.77}},
      {"30 even bands", {0.12, 0.022}},
      {"60 even bands", {0.053, 0.0093}},
      {"16 leaves of a tree", {0.52, 0.088}},
      {"32 leaves of a tree", {0.1, 0.029}},
      {"16 intervals and spikes", {0.34, 0.063}},
      {"32 intervals and spikes", {0.13, 0.03}},
      {"4 cubic polynomials", {0.27, 0.069}},
      {"linear basis, 4 functions", {0.91, 0.2}},
      {"linear basis, 8 functions", {0.17, 0.056}},
      {"16 stratified wavelengths, 1 sample", {4.1, 0.42}},
      {"16 stratified wavelengths, 16 samples", {0.15, 0.026}},
      {"4 hero wavelengths, 4 samples", {23, 2.3}},
      {"4 hero wavelengths, 64 samples", {2.1, 0.19}},
      {"RGB to sigmoids, 60 bands", {2.2, 0.97}},
      {"RGB to tetrahedral, 60 bands", {1.5, 0.66}},
      {"RGB to moments, 60 bands", {1.7, 0.81}},
      {"RGB to smoothest, 60 bands", {1.9, 0.65}},
      {"RGB to least slope, 60 bands", {1.3, 0.45}}};
  const Chart chart("FL11");
  const auto all = *representations_for(chart.paths);
  EXPECT_EQ(all.size(), bounds.size());  // there are no planned bands here
  for (const Representation& r : all) {
    const auto bound = bounds.find(r.name);
    ASSERT_NE(bound, bounds.end()) << r.name;
    EXPECT_LT(chart.error(r, 1).mean, bound->second[0]) << r.name;
    EXPECT_LT(chart.error(r, 5).mean, bound->second[1]) << r.name;
  }
}

TEST(Representations, FewMaterialsAndBlackOnesWillDo) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
    Chart chart("D65");
    auto spectra = *chart_reflectances();
    spectra.erase(spectra.begin() + static_cast<std::ptrdiff_t>(count), spectra.end());
    spectra[0] = Spectrum(ConstantSpectrum(0));
    chart.reflectances = *reference_reflectances(spectra);
    chart.paths = *path_scene(chart.methods);
    const auto all = representations_for(chart.paths);
    ASSERT_TRUE(all) << all.error().message;
    for (const Representation& r : *all) {
      const double mean = chart.error(r, 2).mean;
      EXPECT_LT(mean, 10) << r.name;
    }
  }
}

}  // namespace
}  // namespace spectile::test
