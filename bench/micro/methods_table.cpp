// What each method costs in error, as the tables of docs/methods.md: round trips over the cube, gamuts, and
// measured reflectances under other lights. usage: spectile_bench_methods [FOLDER with the measured
// reflectances]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <spectile/spectile.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "bench/micro/report.hpp"
#include "src/upsampling/exact_basis.hpp"

namespace {

using namespace spectile;
using report::need;

struct Named {
  std::string name;
  MeasuredSpectrum spectrum;
};

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out;
  std::stringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

/// Files of name,wavelength,value lines, or of a wavelength and a column for each spectrum.
std::vector<Named> read_reflectances(const std::string& path) {
  std::ifstream in(path);
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> columns;
  std::string line;
  if (!std::getline(in, line)) return {};
  const std::vector<std::string> heading = cells(line);
  while (std::getline(in, line)) {
    const std::vector<std::string> row = cells(line);
    if (heading[0] == "name") {
      auto& column = columns[row[0]];
      column.first.push_back(std::stod(row[1]));
      column.second.push_back(std::stod(row[2]));
      continue;
    }
    for (std::size_t i = 1; i < row.size(); ++i) {
      columns[heading[i]].first.push_back(std::stod(row[0]));
      columns[heading[i]].second.push_back(std::clamp(std::stod(row[i]), 0.0, 1.0));
    }
  }
  std::vector<Named> out;
  for (const auto& [name, column] : columns) {
    out.push_back({name, need(MeasuredSpectrum::from_samples(column.first, column.second))});
  }
  return out;
}

/// Mean, largest and others of a list.
struct Statistics {
  std::vector<double> values;
  void add(double v) { values.push_back(v); }
  double mean() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
  }
  double most() const { return values.empty() ? 0 : *std::max_element(values.begin(), values.end()); }
};

double difference(const std::array<double, 3>& a, const std::array<double, 3>& b,
                  const std::array<double, 3>& white) {
  return ciede2000(xyz_to_lab(a, white), xyz_to_lab(b, white));
}

void print_round_trips() {
  constexpr std::size_t kSide = 65;
  constexpr std::size_t kColors = kSide * kSide * kSide;
  const Bands bands;
  const Projector d65 = need(Projector::reflective(bands, need(illuminant("D65"))));
  ColorLanes rgb = need(ColorLanes::create(kColors));
  ColorLanes xyz = need(ColorLanes::create(kColors));
  ColorLanes back = need(ColorLanes::create(kColors));
  SampledSpectra spectra = need(SampledSpectra::create(bands, kColors));
  for (std::size_t i = 0; i < kColors; ++i) {
    rgb.at(i, 0) = static_cast<float>(i % kSide) / (kSide - 1);
    rgb.at(i, 1) = static_cast<float>(i / kSide % kSide) / (kSide - 1);
    rgb.at(i, 2) = static_cast<float>(i / kSide / kSide) / (kSide - 1);
  }
  fmt::print("Round trip of a 65 x 65 x 65 grid of linear sRGB, 60 bands, float throughout\n\n");
  fmt::print(
      "| method | largest error of a channel | CIEDE2000 mean, max | samples | roughness mean, max |\n");
  fmt::print("|---|---:|---:|---|---:|\n");
  for (const std::string& name : method_names()) {
    const Upsampler upsampler =
        need(Upsampler::create(need(parse_method(name)), Quantity::kReflectance, bands));
    need(upsample_srgb(upsampler, rgb.view(), spectra.span()));
    need(project(d65, spectra.view(), xyz.span()));
    need(transform(d65.xyz_to_srgb(), xyz.view(), back.span()));
    const Matrix3 to_xyz = inverse(d65.xyz_to_srgb());
    double error = 0;
    float low = 1;
    float high = 0;
    Statistics color, rough;
    std::vector<double> spectrum(bands.count());
    for (std::size_t i = 0; i < kColors; ++i) {
      std::array<double, 3> before{};
      std::array<double, 3> after{};
      for (std::size_t k = 0; k < 3; ++k) {
        before[k] = rgb.at(i, k);
        after[k] = xyz.at(i, k);
        error = std::max(error, std::abs(static_cast<double>(back.at(i, k)) - before[k]));
      }
      color.add(difference(times(to_xyz, before), after, d65.white()));
      for (std::size_t b = 0; b < bands.count(); ++b) {
        spectrum[b] = spectra.at(i, b);
        low = std::min(low, spectra.at(i, b));
        high = std::max(high, spectra.at(i, b));
      }
      rough.add(std::sqrt(roughness(bands, spectrum)));
    }
    fmt::print("| `{}` | {:.1e} | {:.1e}, {:.1e} | {:.3g} to {:.6g} | {:.3f}, {:.3f} |\n", name, error,
               color.mean(), color.most(), low, high, rough.mean(), rough.most());
  }
  fmt::print("\nRoughness: root of the sum of squared second differences over the bands.\n\n");
}

void print_gamuts() {
  constexpr std::size_t kSide = 33;
  constexpr std::size_t kColors = kSide * kSide * kSide;
  const Bands bands;
  const Projector d65 = need(Projector::reflective(bands, need(illuminant("D65"))));
  const Matrix3 to_xyz = inverse(d65.xyz_to_srgb());
  fmt::print(
      "Reflectances: share of a 33 x 33 x 33 grid that each method makes, and what moving the others along "
      "their dominant wavelength costs, CIEDE2000 mean (of those moved), max\n\n| input space |");
  const std::vector<std::string> methods = {"smits-exact", "sigmoid"};
  for (const std::string& name : methods) fmt::print(" `{}` covers | costs |", name);
  fmt::print("\n|---|---:|---:|---:|---:|\n");
  for (const char* space_name : {"srgb", "display-p3", "adobe-rgb", "rec2020", "acescg", "aces2065-1"}) {
    const RgbSpace space = need(rgb_space(space_name));
    const Matrix3 adapt =
        adaptation_matrix(Adaptation::kBradford, xyz_of(space.chromaticities.white), xyz_of(kRec709.white));
    const Matrix3 matrix = product(xyz_to_srgb_matrix(), product(adapt, rgb_to_xyz(space.chromaticities)));
    fmt::print("| {} |", space_name);
    for (const std::string& name : methods) {
      const Upsampler upsampler =
          need(Upsampler::create(need(parse_method(name)), Quantity::kReflectance, bands));
      ColorLanes rgb = need(ColorLanes::create(kColors));
      std::vector<std::array<double, 3>> before(kColors);
      for (std::size_t i = 0; i < kColors; ++i) {
        const double side = kSide - 1;
        before[i] = times(
            matrix, {static_cast<double>(i % kSide) / side, static_cast<double>(i / kSide % kSide) / side,
                     static_cast<double>(i / kSide / kSide) / side});
        // A rounding error outside the cube is inside.
        for (std::size_t k = 0; k < 3; ++k) {
          const double v = std::abs(before[i][k]) < 1e-7 ? 0.0 : before[i][k];
          rgb.at(i, k) = static_cast<float>(std::abs(v - 1) < 1e-7 ? 1.0 : v);
        }
      }
      const GamutReport found = need(gamut_clip(upsampler, rgb.span(), OutOfGamut::kClip));
      Statistics cost;
      for (std::size_t i = 0; i < kColors; ++i) {
        const std::array<double, 3> after = {rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)};
        double moved = 0;
        for (std::size_t k = 0; k < 3; ++k) moved = std::max(moved, std::abs(after[k] - before[i][k]));
        if (moved < 1e-5) continue;
        cost.add(difference(times(to_xyz, before[i]), times(to_xyz, after), d65.white()));
      }
      fmt::print(" {:.1f} % | {:.2f}, {:.1f} |", 100 - 100.0 * static_cast<double>(found.outside) / kColors,
                 cost.mean(), cost.most());
    }
    fmt::print("\n");
  }
  fmt::print("\n");
}

void print_relighting(const std::vector<Named>& measured, const std::string& what) {
  const Bands bands;
  const Projector d65 = need(Projector::reflective(bands, need(illuminant("D65"))));
  const std::vector<std::string> lights = {"A", "FL2", "FL11", "LED-B3", "HP1"};
  std::map<std::string, std::map<std::string, Statistics>> found;
  std::size_t inside = 0;
  for (const Named& one : measured) {
    SampledSpectra truth = need(SampledSpectra::broadcast(bands, 1, one.spectrum.average_over(bands)));
    const auto seen = [&](const Projector& under, const SampledSpectra& spectra) {
      std::array<double, 3> xyz{};
      for (std::size_t b = 0; b < bands.count(); ++b) {
        for (std::size_t k = 0; k < 3; ++k) {
          xyz[k] += under.weights()[b][k] * static_cast<double>(spectra.at(0, b));
        }
      }
      return xyz;
    };
    const auto color = times(d65.xyz_to_srgb(), seen(d65, truth));
    if (*std::min_element(color.begin(), color.end()) < 0 ||
        *std::max_element(color.begin(), color.end()) > 1)
      continue;
    ++inside;
    ColorLanes rgb = need(ColorLanes::create(1));
    for (std::size_t k = 0; k < 3; ++k) rgb.at(0, k) = static_cast<float>(color[k]);
    for (const std::string& name : method_names()) {
      static std::map<std::string, Upsampler> upsamplers;
      if (!upsamplers.contains(name)) {
        upsamplers.emplace(name,
                           need(Upsampler::create(need(parse_method(name)), Quantity::kReflectance, bands)));
      }
      SampledSpectra made = need(SampledSpectra::create(bands, 1));
      need(upsample_srgb(upsamplers.at(name), rgb.view(), made.span()));
      for (const std::string& light : lights) {
        const Projector under = need(Projector::reflective(bands, need(illuminant(light))));
        found[name][light].add(difference(seen(under, truth), seen(under, made), under.white()));
      }
    }
  }
  fmt::print(
      "{}: {} of {} are inside sRGB under D65; CIEDE2000 mean, max of the upsampled under other lights\n\n",
      what, inside, measured.size());
  fmt::print("| method |");
  for (const std::string& light : lights) fmt::print(" {} |", light);
  fmt::print(" mean of all |\n|---|---:|---:|---:|---:|---:|---:|\n");
  for (const std::string& name : method_names()) {
    fmt::print("| `{}` |", name);
    double sum = 0;
    for (const std::string& light : lights) {
      sum += found[name][light].mean() / static_cast<double>(lights.size());
      fmt::print(" {:.2f}, {:.1f} |", found[name][light].mean(), found[name][light].most());
    }
    fmt::print(" {:.2f} |\n", sum);
  }
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  print_round_trips();
  print_gamuts();
  if (argc < 2) return 0;
  const std::string folder = argv[1];
  std::vector<Named> all = read_reflectances(folder + "/colorchecker_babelcolor_10nm.csv");
  print_relighting(all, "24 patches of the ColorChecker (BabelColor)");
  const std::vector<Named> more = read_reflectances(folder + "/reflectances_190_patches_5nm.csv");
  print_relighting(more, "190 patches (AMPAS rawtoaces)");
  all.insert(all.end(), more.begin(), more.end());
  print_relighting(all, "All 214");
  return 0;
}
