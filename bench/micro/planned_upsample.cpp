// A texture upsampled to the bands of a plan and to sixty even ones: time, size and error, interleaved,
// medians. usage: spectile_bench_planned FOLDER [SIZE [RUNS [BANDS]]]   (default 4096 3 8; FOLDER takes the
// files)
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <spectile/spectile.hpp>

#include "bench/micro/noise_texture.hpp"
#include "bench/micro/or_exit.hpp"

namespace {

using namespace spectile;
using bench::median;
using bench::value_or_exit;
namespace fs = std::filesystem;

void make_texture(const std::string& path, int size) {
  const auto n = static_cast<std::size_t>(size);
  ColorLanes rgb = value_or_exit(ColorLanes::create(n * n));
  for (std::size_t i = 0; i < n * n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      rgb.at(i, k) = static_cast<float>(bench::texture(i % n, i / n, k));
    }
  }
  bench::done_or_exit(write_rgb_image(path, rgb.view(), size, size));
}

/// Colour differences between a texture and what a spectral image of it projects to.
std::pair<double, double> round_trip(const std::string& texture, const std::string& spectral,
                                     const std::string& projected) {
  ProjectImageOptions options;
  options.pixel = PixelType::kFloat;
  value_or_exit(project_image(spectral, projected, options));
  const RgbImage before = value_or_exit(read_rgb_image(texture));
  const RgbImage after = value_or_exit(read_rgb_image(projected));
  const Matrix3& m = srgb_to_xyz_matrix();
  const auto xyz = [&](const RgbImage& image, std::size_t i) {
    std::array<double, 3> out{};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) out[r] += m[3 * r + c] * static_cast<double>(image.rgb.at(i, c));
    }
    return out;
  };
  const std::array<double, 3> white = {m[0] + m[1] + m[2], m[3] + m[4] + m[5], m[6] + m[7] + m[8]};
  double sum = 0;
  double most = 0;
  // Every seventeenth pixel: a million.
  std::size_t count = 0;
  for (std::size_t i = 0; i < before.rgb.lanes(); i += 17, ++count) {
    const double d = ciede2000(xyz_to_lab(xyz(before, i), white), xyz_to_lab(xyz(after, i), white));
    sum += d;
    most = std::max(most, d);
  }
  fs::remove(projected);
  return {sum / static_cast<double>(count), most};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 5) {
    fmt::print(stderr, "usage: {} FOLDER [SIZE [RUNS [BANDS]]]\n", argv[0]);
    return 2;
  }
  const fs::path folder = argv[1];
  const int size = argc > 2 ? static_cast<int>(std::strtol(argv[2], nullptr, 10)) : 4096;
  const int runs = argc > 3 ? static_cast<int>(std::strtol(argv[3], nullptr, 10)) : 3;
  const int count = argc > 4 ? static_cast<int>(std::strtol(argv[4], nullptr, 10)) : 8;
  if (size < 1 || runs < 1 || count < 3) return 2;
  const std::string texture = (folder / "texture.exr").string();
  make_texture(texture, size);

  PlannerOptions planner;
  planner.lights = {{"D65", value_or_exit(find_spectrum("D65"))}};
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind == "reflectance") planner.reflectances.push_back(value_or_exit(named_spectrum(info.name)));
  }
  // What the texture itself holds.
  const auto own = value_or_exit(texture_reflectances(texture, 160));
  planner.reflectances.insert(planner.reflectances.end(), own.begin(), own.end());
  planner.bands = static_cast<std::size_t>(count);
  planner.sampling = PlanSampling::kBands;
  const Plan plan = value_or_exit(make_plan(planner));
  fmt::print("{0} x {0} texture, D65, half, {1} runs interleaved, medians\n", size, runs);
  fmt::print("{} planned bands promise CIEDE2000 {:.3f} ({:.2f} at most)", count, plan.promises[0].error.mean,
             plan.promises[0].error.maximum);
  for (const EvenBandsPromise& even : plan.even) {
    fmt::print("; {} have {:.3f} ({:.2f})", even.bands, even.promise.error.mean, even.promise.error.maximum);
  }
  fmt::print(
      "\n\n| compression | 60 even: s | MB | planned: s | MB | faster | smaller | round trip, 60 even | "
      "planned |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  const std::string even_file = (folder / "even.exr").string();
  const std::string planned_file = (folder / "planned.exr").string();
  for (const char* compression : {"none", "zip:1", "zip:4", "piz"}) {
    UpsampleImageOptions even;
    even.compression = value_or_exit(Compression::parse(compression));
    UpsampleImageOptions planned = even;
    planned.bands = value_or_exit(Bands::of_plan(plan));
    std::vector<double> even_s;
    std::vector<double> planned_s;
    ImageReport a;
    ImageReport b;
    for (int run = 0; run < runs; ++run) {
      a = value_or_exit(upsample_image(texture, even_file, even));
      b = value_or_exit(upsample_image(texture, planned_file, planned));
      even_s.push_back(a.seconds);
      planned_s.push_back(b.seconds);
    }
    const auto error_a = round_trip(texture, even_file, (folder / "back.exr").string());
    const auto error_b = round_trip(texture, planned_file, (folder / "back.exr").string());
    const auto mb = [](const ImageReport& r) { return static_cast<double>(r.bytes_written) * 1e-6; };
    fmt::print(
        "| {} | {:.2f} | {:.0f} | {:.2f} | {:.0f} | {:.1f} | {:.1f} | {:.4f}, {:.3f} | {:.4f}, {:.3f} |\n",
        compression, median(even_s), mb(a), median(planned_s), mb(b), median(even_s) / median(planned_s),
        mb(a) / mb(b), error_a.first, error_a.second, error_b.first, error_b.second);
    std::fflush(stdout);
  }
  for (const std::string& file : {texture, even_file, planned_file}) fs::remove(file);
  return 0;
}
