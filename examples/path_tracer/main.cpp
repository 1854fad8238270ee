// Command line of the path tracer: renders the box, compares representations, or checks itself.
#include <charconv>
#include <cstdio>
#include <span>

#include "checks.hpp"
#include "compare.hpp"
#include "render.hpp"

namespace {

using namespace tracer;

constexpr const char* kUsage =
    "usage: example_path_tracer [options]\n"
    "  --wavelengths uniform|visible|light  four wavelengths a path, drawn so (light)\n"
    "  --bands even|planned                 bands that all paths share\n"
    "  --reference                          bands of 1 nm, 360 to 830 nm\n"
    "  --size N  --samples N                pixels a side (128), samples a pixel (16)\n"
    "  --threads N  --batch LANES           workers (2), paths of each (by the cache)\n"
    "  --limit COMPONENT                    largest X, Y or Z of a sample; biased, but for no bright dots\n"
    "  --furnace                            a closed box of albedo 0.5 that gives off 1\n"
    "  --stats                              prints where the time went\n"
    "  --compare                            prints errors and times of all representations\n"
    "  --check furnace|energy|bits|convergence|variance\n"
    "  -o FILE.exr                          linear sRGB\n";

struct Options {
  Representation representation = Representation::kLight;
  RenderSettings settings;
  std::string output;
  std::string check;
  bool furnace = false, stats = false, compare = false;
};

bool read_number(std::string_view text, auto& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size() && out > 0;
}

/// An option without a value; false if it is none.
bool read_flag(std::string_view name, Options& out) {
  if (name == "--furnace") return out.furnace = true;
  if (name == "--stats") return out.stats = true;
  if (name == "--compare") return out.compare = true;
  if (name != "--reference") return false;
  out.representation = Representation::kReference;
  return true;
}

/// An option with its value; false if either is unknown.
bool read_option(std::string_view name, std::string_view value, Options& out) {
  if (name == "--wavelengths" || name == "--bands") {
    const auto chosen = parse_representation(value);
    const bool bands = chosen == Representation::kEven || chosen == Representation::kPlanned;
    if (!chosen || chosen == Representation::kReference || bands != (name == "--bands")) return false;
    out.representation = *chosen;
    return true;
  }
  if (name == "--size") return read_number(value, out.settings.size) && out.settings.size <= 8192;
  if (name == "--samples")
    return read_number(value, out.settings.samples) && out.settings.samples <= 1U << 20U;
  if (name == "--threads") return read_number(value, out.settings.threads) && out.settings.threads <= 1024;
  if (name == "--batch") return read_number(value, out.settings.batch) && out.settings.batch <= 1U << 20U;
  if (name == "--limit") return read_number(value, out.settings.limit);
  if (name == "--check") return !(out.check = value).empty();
  if (name == "-o") return !(out.output = value).empty();
  return false;
}

bool parse(std::span<char*> arguments, Options& out) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view name = arguments[i];
    if (read_flag(name, out)) continue;
    if (i + 1 == arguments.size() || !read_option(name, arguments[++i], out)) {
      (void)std::fprintf(stderr, "cannot read the option %s\n%s", std::string(name).c_str(), kUsage);
      return false;
    }
  }
  return true;
}

/// The first lamp's white becomes that of sRGB, so that the other's light has its tint beside it.
Result<void> write_picture(const Scene& scene, const Film& film, const std::string& path) {
  SPECTILE_ASSIGN(const auto white, white_of(scene.lamps[0]));
  const auto adapted = adaptation_matrix(Adaptation::kBradford, white, chromaticity_to_xyz(kRec709.white));
  SPECTILE_ASSIGN(auto rgb, xyz_of(film));
  SPECTILE_TRY(transform(product(xyz_to_srgb_matrix(), adapted), rgb, rgb));
  ImageOptions options;
  options.pixel = SampleType::kFloat;
  return write_rgb_image(path, rgb, film.options().width, film.options().height, options);
}

Result<bool> run(const Options& options) {
  if (!options.check.empty()) return run_check(options.check);
  if (options.compare) return compare_representations(options.settings);
  Scene scene = box_scene();
  RenderSettings settings = options.settings;
  if (options.furnace) {
    scene = furnace_scene({0.5F, 0.5F, 0.5F});
    settings.roulette_from = RenderSettings::kNever;
    settings.next_event = false;
  }
  SPECTILE_ASSIGN(const auto spectra, SpectralScene::create(scene, options.representation));
  SPECTILE_ASSIGN(const auto rendered, render(scene, spectra, settings));
  if (options.stats) print_stats(options.representation, rendered, settings);
  if (!options.output.empty()) SPECTILE_TRY(write_picture(scene, rendered.film, options.output));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(std::span(argv, static_cast<std::size_t>(argc)).subspan(1), options)) return 2;
  const auto good = run(options);
  if (!good) {
    (void)std::fprintf(stderr, "%s\n", good.error().message.c_str());
    return 2;
  }
  return *good ? 0 : 1;
}
