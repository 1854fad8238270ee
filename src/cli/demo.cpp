// spectile demo: the main job on a chart made here.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/plot.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

struct DemoArguments {
  Common common;
  std::string directory = "spectile-demo";
};

constexpr int kWidth = 1536;
constexpr int kHeight = 1024;

/// Colour at hue h (0 to 6), saturation and value.
std::array<double, 3> from_hsv(double h, double s, double v) {
  std::array<double, 3> out{};
  for (int k = 0; k < 3; ++k) {
    const double t = std::fmod(h + (k == 0 ? 5.0 : k == 1 ? 3.0 : 1.0), 6.0);
    out[static_cast<std::size_t>(k)] = v * (1 - s * std::clamp(std::min(t, 4 - t), 0.0, 1.0));
  }
  return out;
}

/// The chart: hue against value at full and at half saturation, greys in steps, and the cube's corners.
std::array<double, 3> chart_color(int x, int y) {
  const double u = (x + 0.5) / kWidth;
  const double v = (y + 0.5) / kHeight;
  if (v < 0.40) return from_hsv(6 * u, 1.0, 1 - v / 0.40);
  if (v < 0.70) return from_hsv(6 * u, 0.5, 1 - (v - 0.40) / 0.30);
  if (v < 0.85) {
    const double grey = std::floor(u * 21) / 20;
    return {grey, grey, grey};
  }
  const int corner = std::min(static_cast<int>(u * 8), 7);
  return {(corner & 4) != 0 ? 1.0 : 0.0, (corner & 2) != 0 ? 1.0 : 0.0, (corner & 1) != 0 ? 1.0 : 0.0};
}

/// Throws: Stop.
ColorLanes make_chart() {
  ColorLanes chart = take(ColorLanes::create(std::size_t{kWidth} * kHeight));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto color = chart_color(x, y);
      const auto lane = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
      for (std::size_t k = 0; k < 3; ++k) chart.at(lane, k) = static_cast<float>(color[k]);
    }
  }
  return chart;
}

/// Mean and largest absolute difference over all components.
std::array<double, 2> differences(const RgbImage& a, const RgbImage& b) {
  double sum = 0;
  double maximum = 0;
  for (std::size_t i = 0; i < a.rgb.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = std::abs(static_cast<double>(a.rgb.at(i, k)) - static_cast<double>(b.rgb.at(i, k)));
      sum += d;
      maximum = std::max(maximum, d);
    }
  }
  return {sum / (3.0 * static_cast<double>(a.rgb.lanes())), maximum};
}

int run_demo(const DemoArguments& a) {
  apply_common(a.common);
  catch_signals();
  std::error_code error;
  std::filesystem::create_directories(a.directory, error);
  if (error) {
    return complain({error == std::errc::permission_denied ? ErrorCode::kNoPermission : ErrorCode::kBadFile,
                     fmt::format("{}: cannot be made a directory: {}", a.directory, error.message())});
  }
  const std::filesystem::path folder(a.directory);
  const std::string chart_path = (folder / "chart.exr").string();
  const std::string spectral_path = (folder / "chart-spectral.exr").string();
  const std::string back_path = (folder / "chart-back.exr").string();
  check_files(named_files({chart_path, spectral_path, back_path}, "an image of the demo"), {});

  const ColorLanes chart = make_chart();
  const ProgressFunction go_on = [](const Progress&) { return !interrupted(); };
  ImageOptions plain;
  plain.threads = a.common.threads;
  plain.progress = go_on;
  take(write_rgb_image(chart_path, chart.view(), kWidth, kHeight, plain));
  UpsampleImageOptions up;
  up.threads = a.common.threads;
  up.progress = go_on;
  const ImageReport upsampled = take(upsample_image(chart_path, spectral_path, up));
  ProjectImageOptions down;
  down.threads = a.common.threads;
  down.progress = go_on;
  down.pixel = SampleType::kFloat;
  const ImageReport projected = take(project_image(spectral_path, back_path, down));
  const VerifyReport verified = take(verify_image(chart_path, up));
  const RgbImage before = take(read_rgb_image(chart_path, {}, a.common.threads));
  const RgbImage after = take(read_rgb_image(back_path, {}, a.common.threads));
  const auto [mean, maximum] = differences(before, after);

  if (a.common.json) {
    print_json({{"isa", verified.isa},
                {"chart", chart_path},
                {"spectral", spectral_path},
                {"back", back_path},
                {"upsample_mpixel_per_s", static_cast<double>(upsampled.pixels()) / upsampled.seconds * 1e-6},
                {"project_mpixel_per_s", static_cast<double>(projected.pixels()) / projected.seconds * 1e-6},
                {"different_samples", verified.different_samples},
                {"oracle_difference", verified.max_oracle_difference},
                {"round_trip_mean", mean},
                {"round_trip_max", maximum}});
  } else if (!a.common.quiet) {
    print("{}: {} x {} RGB chart\n", chart_path, kWidth, kHeight);
    print(
        "{}: upsampled to {} bands, {}, {}; kernels ({}) equal the reference in {} of {} samples, which is "
        "within {:.2g} of double\n",
        spectral_path, upsampled.bands, speed_text(upsampled.pixels(), upsampled.seconds),
        size_text(upsampled.bytes_written), verified.isa, verified.samples - verified.different_samples,
        verified.samples, verified.max_oracle_difference);
    print("{}: projected back under D65, {}\n", back_path, speed_text(projected.pixels(), projected.seconds));
    print(
        "round trip: linear sRGB differs by {:.4f} on average, {:.4f} at most: error of the method and of "
        "16-bit rounding\n",
        mean, maximum);
    const std::array<int, 2> at = {kWidth / 6 + 40, kHeight / 8};
    const ImageInfo info = take(inspect_image(spectral_path, at, a.common.threads));
    print("the spectrum of pixel {},{}:\n", at[0], at[1]);
    for (const std::string& line : plot(info.pixel, *info.bands)) print("{}\n", line);
  }
  return verified.ok() ? kOk : kBadInput;
}

}  // namespace

void add_demo(const Command& app, int& exit) {
  const auto [command, a] = add_subcommand(
      app, "demo", "Make a chart, upsample it, project it back; print error and speed of each step", run_demo,
      exit);
  command.positional("DIR", a->directory, "Folder for the three images", "").show_default();
  add_common(command, a->common, "spectile demo /tmp/demo");
}

}  // namespace spectile::cli
