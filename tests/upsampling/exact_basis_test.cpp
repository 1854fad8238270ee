// The exact bases: their colours are the corners of the cube, they lie between 0 and white, none is smoother,
// and they exist where there are such spectra at all.
#include "src/upsampling/exact_basis.hpp"

#include "src/data/tables.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

using Triple = std::array<double, 3>;

// White, cyan, magenta, yellow, red, green, blue.
constexpr Triple kCorners[7] = {{1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

struct Case {
  std::string name;
  Bands bands;
  Quantity quantity = Quantity::kReflectance;
  UpsamplerOptions options;
  WorkingSpace space() const {
    const MeasuredSpectrum light = options.light ? *options.light : *illuminant("D65");
    return *working_space(bands, quantity == Quantity::kIlluminant, options.primaries, light,
                          options.observer);
  }
};

/// A halogen lamp behind glass, as one would measure it: uneven steps, any scale.
MeasuredSpectrum measured_light() {
  const double wavelengths[] = {379.5, 402, 431.3, 470, 507.9, 550, 591, 633.7, 668, 702.4, 751, 781};
  const double values[] = {31, 88, 214, 460, 702, 1003, 1288, 1510, 1642, 1733, 1801, 1815};
  return *MeasuredSpectrum::from_samples(wavelengths, values);
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const char* text :
       {"400:700:5", "380:780:5", "400:700:10", "360:830:2", "420,450,480,510,540,570,600,630,660",
        "400,409,421,434,447,460,473,487,500,512,525,540,552,565,580,595,607,622,640,660,690"}) {
    out.push_back({text, *Bands::parse(text), Quantity::kReflectance, {}});
  }
  for (const char* light : {"D50", "E", "A", "FL7"}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
      UpsamplerOptions options;
      options.light = *illuminant(light);
      out.push_back(
          {std::string(light) + " " + std::string(to_string(quantity)), Bands(), quantity, options});
    }
  }
  UpsamplerOptions measured;
  measured.light = measured_light();
  out.push_back({"a measured light", Bands(), Quantity::kReflectance, measured});
  UpsamplerOptions ten_degrees;
  ten_degrees.observer = Observer::kCie1964;
  out.push_back({"10 degrees", Bands(), Quantity::kReflectance, ten_degrees});
  out.push_back({"10 degrees, light", Bands(), Quantity::kIlluminant, ten_degrees});
  return out;
}

Triple color_of(const WorkingSpace& space, const BasisTable& basis, std::size_t k) {
  Triple sum{};
  for (std::size_t b = 0; b < basis.size(); ++b) {
    for (std::size_t i = 0; i < 3; ++i) sum[i] += space.weights[b][i] * basis[b][k];
  }
  return sum;
}

void expect_exact_corners(const Case& c, const BasisTable& basis, double lowest) {
  const WorkingSpace space = c.space();
  ASSERT_EQ(basis.size(), c.bands.count());
  for (std::size_t k = 0; k < 7; ++k) {
    const Triple color = color_of(space, basis, k);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(color[i], kCorners[k][i], 1e-12) << "basis " << k;
    for (std::size_t b = 0; b < basis.size(); ++b) {
      EXPECT_GE(basis[b][k], lowest) << "basis " << k << " band " << b;
      EXPECT_LE(basis[b][k], space.white[b]) << "basis " << k << " band " << b;
    }
  }
  for (std::size_t b = 0; b < basis.size(); ++b) EXPECT_EQ(basis[b][0], space.white[b]);
}

/// True if a colour is that of some spectrum in [0, 1]: those of all of them are a solid between planes that
/// are each spanned by the colours of two bands. Positive inside.
double depth_in_solid(const WorkingSpace& space, const Triple& color) {
  std::vector<Triple> bands;
  for (std::size_t b = 0; b < space.weights.size(); ++b) {
    Triple v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = space.weights[b][i] * space.white[b];
    bands.push_back(v);
  }
  const auto dot = [](const Triple& u, const Triple& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  double least = INFINITY;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    for (std::size_t j = 0; j < bands.size(); ++j) {
      const Triple& u = bands[i];
      const Triple& v = bands[j];
      const Triple normal = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
      const double length = std::sqrt(dot(normal, normal));
      if (length < 1e-14) continue;
      double support = 0;
      for (const Triple& band : bands) support += std::max(0.0, dot(normal, band));
      least = std::min(least, (support - dot(normal, color)) / length);
    }
  }
  return least;
}

TEST(ExactBasis, SmoothestSpectraHaveTheCornersColours) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto basis = smoothest_basis(c.bands, c.space());
    ASSERT_TRUE(basis);
    expect_exact_corners(c, *basis, 0);
  }
}

TEST(ExactBasis, PrimaryDecompositionsHaveTheCornersColoursAndSumToWhite) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto basis = primary_decomposition(c.bands, c.space());
    if (!basis && c.bands.count() < 10) continue;  // nothing says that there is one
    ASSERT_TRUE(basis);
    expect_exact_corners(c, *basis, -0x1p-52);  // 1 - red - green rounds twice
    for (const auto& row : *basis) {
      const double places = 4 * 0x1p-52 * row[0];
      EXPECT_NEAR(row[4] + row[5] + row[6], row[0], places);
      EXPECT_NEAR(row[1], row[5] + row[6], places);
      EXPECT_NEAR(row[2], row[4] + row[6], places);
      EXPECT_NEAR(row[3], row[4] + row[5], places);
    }
  }
}

TEST(ExactBasis, SecondariesAreWhatPrimariesLeaveOfWhite) {
  // The roughness of 1 - s is that of s, and 1 - red is cyan.
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto basis = smoothest_basis(c.bands, c.space());
    ASSERT_TRUE(basis);
    for (const auto& row : *basis) {
      for (std::size_t k = 1; k < 4; ++k) EXPECT_NEAR(row[k] + row[k + 3], row[0], 1e-6 * row[0]) << k;
    }
  }
}

TEST(ExactBasis, RoughnessIsTheIntegralOfTheSquaredSecondDerivative) {
  for (const char* text : {"400:700:5", "400,409,421,434,447,460,473,487,500"}) {
    const Bands bands = *Bands::parse(text);
    const std::size_t n = bands.count();
    const double unit = (bands[n - 1].centre_nm - bands[0].centre_nm) / static_cast<double>(n - 1);
    std::vector<double> line(n);
    std::vector<double> parabola(n);
    for (std::size_t b = 0; b < n; ++b) {
      const double at = (bands[b].centre_nm - 500) / unit;
      line[b] = 0.3 * at - 2;
      parabola[b] = 0.5 * at * at;
    }
    EXPECT_NEAR(roughness(bands, line), 0, 1e-20);
    // A second derivative of 1 between the middles of the outer gaps.
    const double range =
        (bands[n - 1].centre_nm + bands[n - 2].centre_nm - bands[1].centre_nm - bands[0].centre_nm) /
        (2 * unit);
    EXPECT_NEAR(roughness(bands, parabola), range, 1e-9 * range);
  }
  EXPECT_EQ(roughness(*Bands::parse("500,600"), std::vector<double>{0, 1}), 0);
}

TEST(ExactBasis, NoSpectrumIsSmoother) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const WorkingSpace space = c.space();
    const auto basis = smoothest_basis(c.bands, space);
    ASSERT_TRUE(basis);
    const std::size_t n = c.bands.count();
    for (std::size_t k = 1; k < 7; ++k) {
      std::vector<double> s(n);
      for (std::size_t b = 0; b < n; ++b) s[b] = (*basis)[b][k] / space.white[b];
      // The objective is convex, so that there is no smoother spectrum if multipliers y of the three colour
      // sums make gradient - A^T y zero where a sample is free, not negative at 0 and not positive at 1.
      std::vector<double> gradient(n);
      std::vector<Triple> a(n);
      Matrix3 normal{};
      Triple right{};
      double size = 0;
      for (std::size_t b = 0; b < n; ++b) {
        std::vector<double> up = s;
        std::vector<double> down = s;
        up[b] += 1;
        down[b] -= 1;
        gradient[b] = (roughness(c.bands, up) - roughness(c.bands, down)) / 2;
        for (std::size_t i = 0; i < 3; ++i) a[b][i] = space.weights[b][i] * space.white[b];
        size = std::max(size, std::abs(gradient[b]));
        if (s[b] < 1e-7 || s[b] > 1 - 1e-7) continue;
        for (std::size_t i = 0; i < 3; ++i) {
          right[i] += a[b][i] * gradient[b];
          for (std::size_t j = 0; j < 3; ++j) normal[3 * i + j] += a[b][i] * a[b][j];
        }
      }
      const Triple y = times(inverse(normal), right);
      for (std::size_t b = 0; b < n; ++b) {
        const double left = gradient[b] - (a[b][0] * y[0] + a[b][1] * y[1] + a[b][2] * y[2]);
        // Where a sample only just reaches its bound, it is put there though it would be free a little beside
        // it.
        const double tolerance = 1e-4 * size;
        EXPECT_TRUE(s[b] <= 1e-7 || left <= tolerance) << "basis " << k << " band " << b << ": " << left;
        EXPECT_TRUE(s[b] >= 1 - 1e-7 || left >= -tolerance) << "basis " << k << " band " << b << ": " << left;
      }
    }
  }
}

TEST(ExactBasis, PrimaryDecompositionStaysNearThePublishedSpectra) {
  const auto nearness = [](const Bands& bands, const UpsamplerOptions& options) {
    const auto upsampler = *Upsampler::create(Method::kMallett, Quantity::kReflectance, bands, options);
    double worst = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto published = *MeasuredSpectrum::from_samples(data::kMallettYuksel.wavelengths_nm,
                                                             data::kMallettYuksel.primaries[k]);
      for (std::size_t b = 0; b < bands.count(); ++b) {
        const double average = published.integral(bands[b].lower_nm, bands[b].upper_nm) / bands[b].width_nm();
        worst = std::max(worst, std::abs(upsampler.basis()[b][4 + k] - average));
      }
    }
    return worst;
  };
  // As measured, and a little. Under the light that it is published for it hardly moves; under another it has
  // to.
  EXPECT_LE(nearness(*Bands::parse("380:780:5"), {}), 0.0105);
  EXPECT_LE(nearness(Bands(), {}), 0.0048);
  UpsamplerOptions under_d50;
  under_d50.light = *illuminant("D50");
  EXPECT_LE(nearness(Bands(), under_d50), 0.061);
}

TEST(ExactBasis, ThereIsOneExactlyWhereTheSolidOfColoursHoldsTheCorners) {
  std::vector<Case> more = cases();
  for (const char* space : {"display-p3", "adobe-rgb", "rec2020", "acescg"}) {
    UpsamplerOptions options;
    options.primaries = rgb_space(space)->chromaticities;
    more.push_back({space, Bands(), Quantity::kReflectance, options});
  }
  for (const char* light : {"C", "D75", "FL2", "FL8", "FL9", "FL10", "FL11", "FL12", "LED-B1", "LED-RGB1"}) {
    UpsamplerOptions options;
    options.light = *illuminant(light);
    more.push_back({light, Bands(), Quantity::kReflectance, options});
    more.push_back({std::string(light) + " itself", Bands(), Quantity::kIlluminant, options});
  }
  for (const char* text :
       {"450,550,610", "450,500,550,610", "430,470,520,570,620", "430,470,510,550,600,650"}) {
    more.push_back({text, *Bands::parse(text), Quantity::kReflectance, {}});
  }
  for (const Case& c : more) {
    const WorkingSpace space = c.space();
    double depth = INFINITY;
    for (std::size_t k = 1; k < 7; ++k) depth = std::min(depth, depth_in_solid(space, kCorners[k]));
    EXPECT_EQ(smoothest_basis(c.bands, space).has_value(), depth > 0) << c.name << ": " << depth;
  }
}

TEST(ExactBasis, ThereAreBasesWhereTheStepsOfTheSolverBreakDown) {
  // A decomposition into primaries shows that the corners are colours of reflectances.
  for (const char* light : {"FL10", "FL11"}) {
    const Bands bands = *Bands::parse("380:780:5");
    const auto space = *working_space(bands, false, kRec709, *illuminant(light), Observer::kCie1931);
    ASSERT_TRUE(primary_decomposition(bands, space)) << light;
    EXPECT_TRUE(smoothest_basis(bands, space)) << light;
  }
  const Bands wide = *Bands::parse("360:830:5");
  const auto d65 = *working_space(wide, false, kRec709, *illuminant("D65"), Observer::kCie1964);
  EXPECT_TRUE(smoothest_basis(wide, d65));
  // Found by projected gradients, with a residual below 1e-12.
  const Bands bands = *Bands::parse("380:780:5");
  const auto ten = *working_space(bands, false, kRec709, *illuminant("D65"), Observer::kCie1964);
  EXPECT_TRUE(primary_decomposition(bands, ten));
}

TEST(ExactBasis, PrimaryDecompositionsAreNotBelowZero) {
  for (const char* light : {"A", "FL7"}) {
    UpsamplerOptions options;
    options.light = *illuminant(light);
    for (const char* bands : {"400:700:5", "380:780:5"}) {
      const auto upsampler =
          *Upsampler::create(Method::kMallett, Quantity::kReflectance, *Bands::parse(bands), options);
      for (const auto& row : upsampler.basis()) {
        for (const double v : row) EXPECT_GE(v, 0) << light << " " << bands;
      }
    }
  }
}

}  // namespace
}  // namespace spectile::test
