// How many bands a colour needs: errors of even and of planned bands over measured reflectances,
// cross-validated, as a table and a picture. usage: spectile_bench_plan DIR [PLOT.svg]   (DIR holds measured
// reflectances)
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <map>
#include <spectile/spectile.hpp>

#include "bench/micro/line_plot.hpp"
#include "bench/micro/or_exit.hpp"

namespace {

using namespace spectile;
using bench::value_or_exit;

const char* const kLights[] = {"D65", "A", "FL2", "FL11", "HP1", "LED-B3", "LED-RGB1"};

PlannedLight light(const std::string& name) {
  return {name, value_or_exit(find_spectrum(name))};
}

/// Errors by light and number of bounces.
using Errors = std::map<std::pair<std::string, int>, PlanError>;

Errors even(const char* bands, const std::vector<Spectrum>& reflectances) {
  Errors out;
  for (const char* name : kLights) {
    for (const int bounces : {1, 2}) {
      out[{name, bounces}] = value_or_exit(
          even_bands_error(value_or_exit(Bands::parse(bands)), light(name), reflectances, bounces));
    }
  }
  return out;
}

struct Planned {
  Errors errors;
  double seconds = 0;  ///< with the cross-validation; the longest of several
};

Planned planned(const std::vector<std::string>& lights, std::size_t bands, PlanSampling sampling, int bounces,
                const std::vector<Spectrum>& reflectances) {
  PlannerOptions o;
  for (const std::string& name : lights) o.lights.push_back(light(name));
  o.reflectances = reflectances;
  o.bands = bands;
  o.sampling = sampling;
  o.bounces = bounces;
  // One thread's processor time: other work on the machine does not count.
  const std::clock_t start = std::clock();
  const Plan plan = value_or_exit(make_plan(o));
  Planned out;
  out.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  for (const PlanPromise& p : plan.promises) out.errors[{p.light, p.bounces}] = p.error;
  return out;
}

/// A plan for each light on its own.
Planned each(std::size_t bands, PlanSampling sampling, int bounces,
             const std::vector<Spectrum>& reflectances) {
  Planned out;
  for (const char* name : kLights) {
    const Planned one = planned({name}, bands, sampling, bounces, reflectances);
    out.errors.insert(one.errors.begin(), one.errors.end());
    out.seconds = std::max(out.seconds, one.seconds);
  }
  return out;
}

void print_row(const std::string& what, const Errors& errors, int bounces, const std::string& note) {
  fmt::print("| {} |", what);
  for (const char* name : kLights) {
    const auto found = errors.find({name, bounces});
    fmt::print(" {:.3f}, {:.2f} |", found->second.mean, found->second.maximum);
  }
  fmt::print(" {} |\n", note);
  std::fflush(stdout);
}

void print_head(const char* title) {
  fmt::print("\n{}\n\n| bands |", title);
  for (const char* name : kLights) fmt::print(" {} |", name);
  fmt::print(" time |\n|---|");
  for (std::size_t i = 0; i < std::size(kLights); ++i) fmt::print("---|");
  fmt::print("---|\n");
}

/// One count of a target that was set, and how many of the lights meet it.
void print_target(const char* what, const Errors& errors, int bounces, double mean, double maximum) {
  int met = 0;
  std::string missed;
  for (const char* name : kLights) {
    const PlanError& e = errors.at({name, bounces});
    const bool good = e.mean < mean && e.maximum < maximum;
    met += good ? 1 : 0;
    if (!good) missed += fmt::format(" {} ({:.3f}, {:.2f})", name, e.mean, e.maximum);
  }
  fmt::print("{}: {} of {} lights{}{}\n", what, met, std::size(kLights), missed.empty() ? "" : "; not",
             missed);
}

void draw(const char* path, const std::vector<Spectrum>& reflectances) {
  constexpr std::size_t kCounts[] = {5, 6, 8, 10, 12, 16, 20};
  bench::Plot plot;
  plot.title = "Colour error against number of bands, reflectances not fitted to";
  plot.x_label = "bands";
  plot.y_label = "CIEDE2000, mean (lines) and maximum (dashed)";
  plot.x0 = 4;
  plot.x1 = 100;
  plot.y0 = 0.004;
  plot.y1 = 40;
  const char* const kEven = "#606060";
  const char* const kPoints = "#0072b2";
  const char* const kAverages = "#d55e00";
  plot.keys = {{"even bands, 400 to 700 nm", {kEven, false, false, {}, {}}},
               {"planned wavelengths", {kPoints, false, false, {}, {}}},
               {"planned bands", {kAverages, false, false, {}, {}}}};
  for (const char* name : {"D65", "A", "FL11", "HP1"}) {
    bench::PlotPanel panel{name, {}};
    const auto add = [&](const char* color, const std::vector<std::pair<double, PlanError>>& line) {
      bench::PlotLine mean{color, false, false, {}, {}};
      bench::PlotLine most{color, true, false, {}, {}};
      for (const auto& [count, error] : line) {
        mean.x.push_back(count);
        mean.y.push_back(error.mean);
        most.x.push_back(count);
        most.y.push_back(error.maximum);
      }
      panel.lines.push_back(std::move(mean));
      panel.lines.push_back(std::move(most));
    };
    std::vector<std::pair<double, PlanError>> line;
    for (const double count : {5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 30.0, 40.0, 60.0}) {
      const auto bands = value_or_exit(Bands::uniform(400, 700, 300 / count));
      line.emplace_back(count, value_or_exit(even_bands_error(bands, light(name), reflectances, 1)));
    }
    add(kEven, line);
    for (const PlanSampling sampling : {PlanSampling::kPoints, PlanSampling::kBands}) {
      line.clear();
      for (const std::size_t count : kCounts) {
        const Planned plan = planned({name}, count, sampling, 1, reflectances);
        line.emplace_back(static_cast<double>(count), plan.errors.at({name, 1}));
      }
      add(sampling == PlanSampling::kPoints ? kPoints : kAverages, line);
    }
    plot.panels.push_back(std::move(panel));
  }
  bench::write_or_exit(path, bench::to_svg(plot));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    fmt::print(stderr, "usage: {} DIR [PLOT.svg [only]]\n", argv[0]);
    return 2;
  }
  auto reflectances = value_or_exit(load_spectra(std::string(argv[1]) + "/reflectances_190_patches_5nm.csv"));
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind == "reflectance") reflectances.push_back(value_or_exit(named_spectrum(info.name)));
  }
  if (argc == 4) {
    draw(argv[2], reflectances);
    return 0;
  }
  fmt::print(
      "{} reflectances; mean, maximum CIEDE2000 against integration every nanometre; planned ones by "
      "five-fold cross-validation\n",
      reflectances.size());
  const std::pair<const char*, const char*> kEven[] = {{"16 even, 400 to 700 nm", "400:700:18.75"},
                                                       {"30 even, 400 to 700 nm", "400:700:10"},
                                                       {"60 even, 400 to 700 nm", "400:700:5"},
                                                       {"80 even, 380 to 780 nm", "380:780:5"}};
  const std::vector<std::string> all(std::begin(kLights), std::end(kLights));
  std::map<std::string, Errors> evens;
  for (const auto& [what, bands] : kEven) evens[what] = even(bands, reflectances);
  const auto seconds = [](const Planned& p) { return fmt::format("{:.1f} s", p.seconds); };
  std::map<int, std::map<std::string, Planned>> found;
  for (const int bounces : {1, 2}) {
    print_head(bounces == 1 ? "One bounce" : "Two bounces (planned for both)");
    for (const auto& [what, bands] : kEven) print_row(what, evens[what], bounces, "");
    for (const std::size_t count : {8U, 12U}) {
      for (const PlanSampling sampling : {PlanSampling::kPoints, PlanSampling::kBands}) {
        const char* kind = sampling == PlanSampling::kPoints ? "wavelengths" : "bands";
        const Planned plan = each(count, sampling, bounces, reflectances);
        print_row(fmt::format("{} {} planned, each light", count, kind), plan.errors, bounces, seconds(plan));
        found[bounces][fmt::format("{} {}", count, kind)] = plan;
      }
    }
    for (const std::size_t count : {12U, 16U}) {
      for (const PlanSampling sampling : {PlanSampling::kPoints, PlanSampling::kBands}) {
        const char* kind = sampling == PlanSampling::kPoints ? "wavelengths" : "bands";
        const std::string key = fmt::format("shared {} {}", count, kind);
        // Planned for two bounces, judged for each.
        if (bounces == 1) found[2][key] = planned(all, count, sampling, 2, reflectances);
        const Planned& plan = found[2][key];
        print_row(fmt::format("{} {} planned, shared", count, kind), plan.errors, bounces, seconds(plan));
      }
    }
  }
  fmt::print("\n");
  for (const char* kind : {"wavelengths", "bands"}) {
    int better = 0;
    const Errors& plan = found[1][fmt::format("8 {}", kind)].errors;
    for (const char* name : kLights) {
      better += plan.at({name, 1}).mean < evens["60 even, 400 to 700 nm"].at({name, 1}).mean ? 1 : 0;
    }
    fmt::print("8 {}, each light: a lower mean than 60 even bands under {} of 7 lights\n", kind, better);
    const auto key = [&](int count) { return fmt::format("{} {}", count, kind); };
    print_target(fmt::format("12 {}, each light, below 0.05 and 0.3", kind).c_str(), found[1][key(12)].errors,
                 1, 0.05, 0.3);
    print_target(fmt::format("12 {}, shared, mean below 0.1", kind).c_str(),
                 found[2]["shared " + key(12)].errors, 1, 0.1, 1e9);
    print_target(fmt::format("16 {}, shared, below 0.04 and 0.2", kind).c_str(),
                 found[2]["shared " + key(16)].errors, 1, 0.04, 0.2);
    print_target(fmt::format("16 {}, shared, two bounces, below 0.3", kind).c_str(),
                 found[2]["shared " + key(16)].errors, 2, 1e9, 0.3);
  }
  if (argc == 3) draw(argv[2], reflectances);
  return 0;
}
