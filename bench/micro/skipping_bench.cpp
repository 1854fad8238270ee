// What black, masked and repeated parts of textures cost, and how many colours the sigmoid solves: wall time,
// interleaved, the least of several runs. usage: spectile_bench_skipping FOLDER [SIZE [RUNS]]
// (default 4096 3; FOLDER takes the files)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <spectile/spectile.hpp>

#include "bench/micro/noise_texture.hpp"
#include "bench/micro/or_exit.hpp"

namespace {

using namespace spectile;
using bench::value_or_exit;
namespace fs = std::filesystem;

/// Whether a pixel is used; the others are black.
using Used = std::function<bool(std::size_t x, std::size_t y)>;

void write(const std::string& path, std::size_t n, const Used& used, double levels) {
  ColorLanes rgb = value_or_exit(ColorLanes::create(n * n));
  for (std::size_t i = 0; i < n * n; ++i) {
    const bool on = used(i % n, i / n);
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = on ? bench::texture(i % n, i / n, k) : 0;
      rgb.at(i, k) = static_cast<float>(levels > 0 ? std::round(v * levels) / levels : v);
    }
  }
  const auto side = static_cast<int>(n);
  ImageOptions options;
  if (levels > 0) options.pixel = PixelType::kFloat;
  bench::done_or_exit(write_rgb_image(path, rgb.view(), side, side, options));
}

struct Case {
  std::string name;
  std::string path;
  UpsampleImageOptions options;
  double seconds = 1e9;
  ImageReport report;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    fmt::print(stderr, "usage: {} FOLDER [SIZE [RUNS]]\n", argv[0]);
    return 2;
  }
  const fs::path folder = argv[1];
  const auto n = static_cast<std::size_t>(
      argc > 2 ? std::max(1, static_cast<int>(std::strtol(argv[2], nullptr, 10))) : 4096);
  const int runs = argc > 3 ? std::max(1, static_cast<int>(std::strtol(argv[3], nullptr, 10))) : 3;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  const Used quadrant = [n](std::size_t x, std::size_t y) { return x < n / 2 && y < n / 2; };
  // Every fourth square of 256 x 256, scattered.
  const Used islands = [](std::size_t x, std::size_t y) {
    return (x / 256 + 3 * (y / 256) + y / 512) % 4 == 0;
  };
  write(
      at("full.exr"), n, [](std::size_t, std::size_t) { return true; }, 0);
  write(at("quadrant.exr"), n, quadrant, 0);
  write(at("islands.exr"), n, islands, 0);
  write(
      at("eight_bits.exr"), n, [](std::size_t, std::size_t) { return true; }, 255);

  std::vector<Case> cases;
  const auto add = [&](const char* name, const char* file) -> Case& {
    cases.push_back({name, at(file), {}, 1e9, {}});
    return cases.back();
  };
  add("full", "full.exr");
  add("three quarters black, one quadrant used", "quadrant.exr");
  add("three quarters black, islands of 256 x 256", "islands.exr");
  for (const char* file : {"full.exr", "islands.exr"}) {
    const bool full = std::string(file) == "full.exr";
    add(full ? "full, --tile 256 256" : "islands, --tile 256 256", file).options.tile = {256, 256};
  }
  Case& masked = add("three quarters masked, colours beneath", "full.exr");
  masked.options.masking = Masking::kFile;
  masked.options.mask = at("quadrant.exr");
  add("full, --no-skip", "full.exr").options.skip = false;
  add("one quadrant used, --no-skip", "quadrant.exr").options.skip = false;
  for (const bool skip : {true, false}) {
    Case& sigmoid =
        add(skip ? "8-bit colours, sigmoid" : "8-bit colours, sigmoid, --no-skip", "eight_bits.exr");
    sigmoid.options.method = Method::kSigmoid;
    sigmoid.options.compression = value_or_exit(Compression::parse("none"));
    sigmoid.options.skip = skip;
  }
  for (int run = 0; run < runs; ++run) {
    for (Case& c : cases) {
      c.report = value_or_exit(upsample_image(c.path, at("out.exr"), c.options));
      c.seconds = std::min(c.seconds, c.report.seconds);
    }
  }
  fmt::print("{0} x {0}, 60 half bands, zip:1 (sigmoid: none), the least of {1} runs\n\n", n, runs);
  fmt::print(
      "| texture | s | against full | MB | chunks reused | colours solved, of pixels "
      "|\n|---|---|---|---|---|---|\n");
  for (const Case& c : cases) {
    const SkipStats& s = c.report.skipped;
    const bool sigmoid = c.options.method == Method::kSigmoid;
    fmt::print(
        "| {} | {:.2f} | {} | {:.0f} | {} of {} | {} |\n", c.name, c.seconds,
        sigmoid ? "" : fmt::format("{:.1f} times as fast", cases[0].seconds / c.seconds),
        static_cast<double>(c.report.bytes_written) * 1e-6, s.chunks_reused, s.chunks,
        s.colors_solved == 0
            ? ""
            : fmt::format("{} of {}, {:.0f} times fewer", s.colors_solved, c.report.pixels(),
                          static_cast<double>(c.report.pixels()) / static_cast<double>(s.colors_solved)));
  }
  for (const char* name : {"full.exr", "quadrant.exr", "islands.exr", "eight_bits.exr", "out.exr"}) {
    fs::remove(at(name));
  }
  return 0;
}
