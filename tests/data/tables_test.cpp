// The published tables against what is printed about them: sums, peaks, smoothness, chromaticities, spot
// values.
#include "src/data/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spectile::data {
namespace {

double sum(std::span<const double> v) {
  return std::accumulate(v.begin(), v.end(), 0.0);
}

/// Sum of every fifth value from 380 to 780 nm.
double sum_of_fifths(std::span<const double> v) {
  double total = 0;
  for (std::size_t lambda_nm = 380; lambda_nm <= 780; lambda_nm += 5) total += v[lambda_nm - 360];
  return total;
}

std::size_t peak_nm(std::span<const double> v) {
  return 360 + static_cast<std::size_t>(std::max_element(v.begin(), v.end()) - v.begin());
}

/// Fourth difference around a wavelength: an error e in one value shows as 6 e there, a smooth curve as
/// almost nothing.
double fourth_difference(std::span<const double> v, std::size_t lambda_nm) {
  const std::size_t i = lambda_nm - 360;
  return v[i - 2] - 4 * v[i - 1] + 6 * v[i] - 4 * v[i + 1] + v[i + 2];
}

const NamedTable& table(std::string_view name) {
  for (const NamedTable& t : illuminants()) {
    if (name == t.name) return t;
  }
  ADD_FAILURE() << name << " is missing";
  return illuminants()[0];
}

/// Chromaticity by sums at 5 nm over 380 to 780 nm, as the CIE computes those it prints.
std::array<double, 2> chromaticity(const NamedTable& light, const MatchingFunctions& observer) {
  double xyz[3] = {};
  for (std::size_t i = 0; i < light.values.size(); ++i) {
    const double lambda_nm = light.first_nm + static_cast<double>(i) * light.step_nm;
    if (lambda_nm < 380 || lambda_nm > 780) continue;
    const auto at = static_cast<std::size_t>(lambda_nm - observer.first_nm);
    xyz[0] += light.values[i] * observer.x_bar[at];
    xyz[1] += light.values[i] * observer.y_bar[at];
    xyz[2] += light.values[i] * observer.z_bar[at];
  }
  const double total = xyz[0] + xyz[1] + xyz[2];
  return {xyz[0] / total, xyz[1] / total};
}

TEST(Data, ObserversCover360To830NmByOne) {
  for (const MatchingFunctions* f : {&kCie1931, &kCie1964}) {
    EXPECT_EQ(f->first_nm, 360.0);
    EXPECT_EQ(f->step_nm, 1.0);
    for (const auto bar : {f->x_bar, f->y_bar, f->z_bar}) {
      EXPECT_EQ(bar.size(), 471U);
      EXPECT_GE(*std::min_element(bar.begin(), bar.end()), 0.0);
    }
  }
}

TEST(Data, SumsOfThe1931ObserverAreThePublished) {
  // Sums of the 1 nm table, as widely quoted to four decimals.
  EXPECT_NEAR(sum(kCie1931.x_bar), 106.8655, 1e-4);
  EXPECT_NEAR(sum(kCie1931.y_bar), 106.8569, 1e-4);
  EXPECT_NEAR(sum(kCie1931.z_bar), 106.8923, 1e-4);
  // Printed under the older 5 nm tables, whose 81 values have four decimals: their roundings, 2.9e-5 each in
  // the mean, add up to 2.6e-4 as a random walk.
  EXPECT_NEAR(sum_of_fifths(kCie1931.x_bar), 21.3714, 3e-4);
  EXPECT_NEAR(sum_of_fifths(kCie1931.y_bar), 21.3711, 3e-4);
  EXPECT_NEAR(sum_of_fifths(kCie1931.z_bar), 21.3715, 3e-4);
}

TEST(Data, SumsOfThe1964ObserverAreThePublished) {
  EXPECT_NEAR(sum(kCie1964.x_bar), 116.6485, 1e-4);
  EXPECT_NEAR(sum(kCie1964.y_bar), 116.6619, 1e-4);
  EXPECT_NEAR(sum(kCie1964.z_bar), 116.6740, 1e-4);
  EXPECT_NEAR(sum_of_fifths(kCie1964.x_bar), 23.3294, 3e-4);
  EXPECT_NEAR(sum_of_fifths(kCie1964.y_bar), 23.3324, 4e-4);
  EXPECT_NEAR(sum_of_fifths(kCie1964.z_bar), 23.3343, 3e-4);
}

TEST(Data, PeaksAreWhereTheyArePublished) {
  EXPECT_EQ(peak_nm(kCie1931.y_bar), 555U);
  EXPECT_EQ(kCie1931.y_bar[555 - 360], 1.0);
  EXPECT_EQ(peak_nm(kCie1931.x_bar), 599U);
  EXPECT_EQ(peak_nm(kCie1931.z_bar), 446U);
  EXPECT_EQ(peak_nm(kCie1964.y_bar), 557U);
  EXPECT_EQ(kCie1964.y_bar[557 - 360], 1.0);
  EXPECT_EQ(peak_nm(kCie1964.x_bar), 595U);
  EXPECT_EQ(peak_nm(kCie1964.z_bar), 445U);
}

TEST(Data, MatchingFunctionsHaveThePublishedValues) {
  struct Row {
    std::size_t lambda_nm;
    double x, y, z;
  };
  // CIE 015, the 5 nm tables.
  const Row two_degree[] = {{400, 0.01431, 0.000396, 0.06785}, {450, 0.3362, 0.038, 1.77211},
                            {500, 0.0049, 0.323, 0.272},       {550, 0.43345, 0.99495, 0.00875},
                            {600, 1.0622, 0.631, 0.0008},      {650, 0.2835, 0.107, 0.0},
                            {700, 0.011359, 0.004102, 0.0}};
  const Row ten_degree[] = {{450, 0.370702, 0.089456, 1.99480},
                            {500, 0.003816, 0.460777, 0.218502},
                            {600, 1.123990, 0.658341, 0.0}};
  const auto expect_row = [](const MatchingFunctions& f, const Row& row) {
    // Half of the printed last digit.
    EXPECT_NEAR(f.x_bar[row.lambda_nm - 360], row.x, 5.1e-6) << row.lambda_nm;
    EXPECT_NEAR(f.y_bar[row.lambda_nm - 360], row.y, 5.1e-6) << row.lambda_nm;
    EXPECT_NEAR(f.z_bar[row.lambda_nm - 360], row.z, 5.1e-6) << row.lambda_nm;
  };
  for (const Row& row : two_degree) expect_row(kCie1931, row);
  for (const Row& row : ten_degree) expect_row(kCie1964, row);
}

TEST(Data, LuminosityAt547NmIsThePublishedAndSmooth) {
  EXPECT_EQ(kCie1931.y_bar[547 - 360], 0.9874182);
  // Seven digits round to 5e-8, which fourth differences raise to at most 16 times that.
  EXPECT_LT(std::abs(fourth_difference(kCie1931.y_bar, 547)), 1e-6);
}

TEST(Data, SmoothnessShowsAnyTwoDigitsExchangedAt547Nm) {
  const std::vector<double> good(kCie1931.y_bar.begin(), kCie1931.y_bar.end());
  const std::string digits = "9874182";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    for (std::size_t j = i + 1; j < digits.size(); ++j) {
      if (digits[i] == digits[j]) continue;
      std::string swapped = digits;
      std::swap(swapped[i], swapped[j]);
      auto bad = good;
      bad[547 - 360] = std::stod("0." + swapped);
      EXPECT_GT(std::abs(fourth_difference(bad, 547)), 1e-6) << swapped;
    }
  }
}

TEST(Data, MatchingFunctionsAreSmoothEverywhere) {
  // Largest values found: 2.3e-4 and 1.3e-3 in y (at 520 and 491 nm, where the CIE joined its data), 5.1e-4
  // in x, 2.1e-3 in z. An error of a few 1e-4 in any value shows.
  for (std::size_t lambda_nm = 362; lambda_nm <= 828; ++lambda_nm) {
    EXPECT_LT(std::abs(fourth_difference(kCie1931.x_bar, lambda_nm)), 4.5e-4) << lambda_nm;
    EXPECT_LT(std::abs(fourth_difference(kCie1931.y_bar, lambda_nm)), 2.4e-4) << lambda_nm;
    EXPECT_LT(std::abs(fourth_difference(kCie1931.z_bar, lambda_nm)), 2.2e-3) << lambda_nm;
    EXPECT_LT(std::abs(fourth_difference(kCie1964.x_bar, lambda_nm)), 5.3e-4) << lambda_nm;
    EXPECT_LT(std::abs(fourth_difference(kCie1964.y_bar, lambda_nm)), 1.4e-3) << lambda_nm;
    EXPECT_LT(std::abs(fourth_difference(kCie1964.z_bar, lambda_nm)), 2.3e-3) << lambda_nm;
  }
}

struct White {
  const char* name;
  double x, y, tolerance;
};

TEST(Data, IlluminantsHaveThePublishedChromaticitiesFor1931) {
  // CIE 015:2018; where five decimals are printed they hold to 4e-5 (the daylights are printed to 0.1 % or so
  // of each sample), where four are to half of the last digit and that.
  constexpr double kFive = 4e-5;
  constexpr double kFour = 9e-5;
  const White whites[] = {{"A", 0.44758, 0.40745, kFive},    {"C", 0.31006, 0.31616, kFive},
                          {"D50", 0.34567, 0.35850, kFive},  {"D55", 0.33242, 0.34743, kFive},
                          {"D65", 0.31272, 0.32903, kFive},  {"D75", 0.29902, 0.31485, kFive},
                          {"D60", 0.32162, 0.33762, kFive},  {"E", 1.0 / 3, 1.0 / 3, kFive},
                          {"FL1", 0.3131, 0.3371, kFour},    {"FL2", 0.3721, 0.3751, kFour},
                          {"FL3", 0.4091, 0.3941, kFour},    {"FL4", 0.4402, 0.4031, kFour},
                          {"FL5", 0.3138, 0.3452, kFour},    {"FL6", 0.3779, 0.3882, kFour},
                          {"FL7", 0.3129, 0.3292, kFour},    {"FL8", 0.3458, 0.3586, kFour},
                          {"FL9", 0.3741, 0.3727, kFour},    {"FL10", 0.3458, 0.3588, kFour},
                          {"FL11", 0.3805, 0.3769, kFour},   {"FL12", 0.4370, 0.4042, kFour},
                          {"HP1", 0.5330, 0.4150, kFour},    {"LED-B1", 0.4560, 0.4078, kFour},
                          {"LED-B3", 0.3756, 0.3723, kFour}, {"LED-RGB1", 0.4557, 0.4211, kFour}};
  EXPECT_EQ(std::size(whites), illuminants().size());
  for (const White& white : whites) {
    const auto xy = chromaticity(table(white.name), kCie1931);
    EXPECT_NEAR(xy[0], white.x, white.tolerance) << white.name;
    EXPECT_NEAR(xy[1], white.y, white.tolerance) << white.name;
  }
}

TEST(Data, IlluminantsHaveThePublishedChromaticitiesFor1964) {
  const White whites[] = {{"A", 0.45117, 0.40594, 4e-5},
                          {"D65", 0.31382, 0.33100, 4e-5},
                          {"D50", 0.34773, 0.35952, 4e-5},
                          {"C", 0.31039, 0.31905, 4e-5}};
  for (const White& white : whites) {
    const auto xy = chromaticity(table(white.name), kCie1964);
    EXPECT_NEAR(xy[0], white.x, white.tolerance) << white.name;
    EXPECT_NEAR(xy[1], white.y, white.tolerance) << white.name;
  }
}

TEST(Data, DaylightsAndAAre100At560Nm) {
  for (const char* name : {"A", "D50", "D55", "D60", "D65", "D75"}) {
    const NamedTable& t = table(name);
    EXPECT_EQ(t.first_nm, 300.0) << name;
    EXPECT_EQ(t.values[static_cast<std::size_t>((560 - t.first_nm) / t.step_nm)], 100.0) << name;
  }
  for (const double value : table("E").values) EXPECT_EQ(value, table("E").values[0]);
}

TEST(Data, IlluminantAFollowsPlancksLaw) {
  // CIE 015: 100 (560/l)^5 (exp(1.435e7/(2848 * 560)) - 1) / (exp(1.435e7/(2848 l)) - 1), printed to six
  // digits.
  const NamedTable& a = table("A");
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double l = a.first_nm + static_cast<double>(i) * a.step_nm;
    const double law =
        100 * std::pow(560 / l, 5) * std::expm1(1.435e7 / (2848 * 560.0)) / std::expm1(1.435e7 / (2848 * l));
    EXPECT_NEAR(a.values[i], law, 5.1e-6 * law + 1e-9) << l;
  }
}

TEST(Data, SmitsTablesHaveThirtyTwoAndTenSamplesFrom380To720Nm) {
  const SmitsData* const sets[] = {&kSmitsReflectance, &kSmitsIlluminant, &kSmits1999};
  const std::size_t counts[] = {32, 32, 10};
  const double scales[] = {0.94, 0.86445, 1.0};
  for (std::size_t s = 0; s < 3; ++s) {
    const SmitsData& data = *sets[s];
    EXPECT_EQ(data.scale, scales[s]);
    ASSERT_EQ(data.wavelengths_nm.size(), counts[s]);
    for (const auto& basis : data.basis) EXPECT_EQ(basis.size(), counts[s]);
    EXPECT_EQ(data.wavelengths_nm.front(), 380.0);
    EXPECT_EQ(data.wavelengths_nm.back(), 720.0);
    const double step = 340.0 / static_cast<double>(counts[s] - 1);
    for (std::size_t i = 0; i < counts[s]; ++i) {
      // Printed to four decimals in the ten-sample table; in the others the step was added up in single
      // precision, which drifts by up to 5.3e-4 nm until the last.
      EXPECT_NEAR(data.wavelengths_nm[i], 380.0 + static_cast<double>(i) * step, s == 2 ? 5.1e-5 : 5.3e-4);
    }
  }
}

TEST(Data, SmitsTablesHaveThePublishedValues) {
  EXPECT_EQ(kSmitsReflectance.basis[0][0], 1.0618958571272863);
  EXPECT_EQ(kSmitsReflectance.basis[1][31], 2.5259399415550079e-02);
  EXPECT_EQ(kSmitsReflectance.basis[4][0], 1.6575604867086180e-01);
  EXPECT_EQ(kSmitsReflectance.basis[6][31], 4.1733649330980525e-03);
  EXPECT_EQ(kSmitsIlluminant.basis[0][0], 1.1565232050369776);
  EXPECT_EQ(kSmitsIlluminant.basis[4][0], 5.4711187157291841e-02);
  EXPECT_EQ(kSmitsIlluminant.basis[6][31], 1.9069090525482305e-01);
  EXPECT_EQ(kSmits1999.basis[1][6], 0.1564);
  EXPECT_EQ(kSmits1999.basis[2][3], 0.2229);
  EXPECT_EQ(kSmits1999.basis[4][7], 1.0149);
  EXPECT_EQ(kSmits1999.basis[5][3], 0.7937);
  EXPECT_EQ(kSmits1999.basis[6][2], 0.8916);
}

TEST(Data, SmitsBasesComplementEachOther) {
  // A secondary and its opposite primary make about white, on average within 0.16 (the largest measured is
  // 0.158, of magenta and green as lights); exchanged rows would miss by more than 0.5.
  for (const SmitsData* data : {&kSmitsReflectance, &kSmitsIlluminant, &kSmits1999}) {
    for (std::size_t k = 0; k < 3; ++k) {
      double gap = 0;
      for (std::size_t i = 0; i < data->wavelengths_nm.size(); ++i) {
        gap += std::abs(data->basis[1 + k][i] + data->basis[4 + k][i] - data->basis[0][i]);
      }
      EXPECT_LT(gap / static_cast<double>(data->wavelengths_nm.size()), 0.16) << k;
    }
  }
}

}  // namespace
}  // namespace spectile::data
