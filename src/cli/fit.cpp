// spectile fit: learns the nodes of the tetrahedral method from measured reflectances.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <spectile/image/nodes_file.hpp>

#include "src/cli/commands.hpp"
#include "src/cli/options/method_options.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

struct FitArguments {
  Common common;
  std::vector<std::string> reflectances;
  std::string white;
  Observer white_observer = Observer::kCie1931;
  SpectrumArguments spectra;
  std::string output;
};

struct Materials {
  std::vector<ReflectanceSet> sets;
  std::size_t count = 0;
  std::vector<std::string> notes;
};

/// Notes what is made up of a file's reflectances, or left out.
void note_limits(const std::string& file, const std::vector<Spectrum>& spectra,
                 std::vector<std::string>& notes) {
  std::size_t held = 0;
  std::size_t limited = 0;
  for (const Spectrum& spectrum : spectra) {
    const auto* table = std::get_if<PiecewiseLinearSpectrum>(&spectrum.kind());
    if (table == nullptr) continue;
    const auto nm = table->wavelengths_nm();
    held += nm.front() > kFirstLearnedNm || nm.back() < kLastLearnedNm ? 1 : 0;
    const auto [low, high] = std::ranges::minmax(table->values());
    limited += low < 0 || high > 1 ? 1 : 0;
  }
  if (held > 0) {
    notes.push_back(fmt::format(
        "{}: {} of {} reflectances are not given from {} to {} nm; beyond their data the nearest value is "
        "taken, and learned",
        file, held, spectra.size(), kFirstLearnedNm, kLastLearnedNm));
  }
  if (limited > 0) {
    notes.push_back(fmt::format("{}: {} of {} reflectances have values below 0 or above 1, which are limited",
                                file, limited, spectra.size()));
  }
}

/// Throws: Stop.
Materials materials_of(const FitArguments& a) {
  Materials out;
  for (const std::string& text : a.reflectances) {
    SpectrumTable table = take(find_reflectances(text, file_options(a.spectra)));
    out.count += table.spectra.size();
    out.notes.insert(out.notes.end(), table.notes.begin(), table.notes.end());
    note_limits(text, table.spectra, out.notes);
    out.sets.push_back({text, std::move(table.spectra)});
  }
  return out;
}

/// The trials' errors by method, in the order that they are shown in.
std::array<std::pair<const char*, const ColorError*>, 4> methods_of(const LearningTrial& trial) {
  return {{{"sigmoid", &trial.sigmoid},
           {"sigmoid-observer", &trial.sigmoid_observer},
           {"tetrahedral", &trial.tetrahedral},
           {"tetrahedral, learned", &trial.learned}}};
}

std::string held_out(const LearningTrial& trial) {
  return trial.held_out.empty() ? std::string("a fifth, five times") : trial.held_out;
}

/// The least mean of the other methods.
double best_other(const LearningTrial& trial) {
  return std::min({trial.sigmoid.mean, trial.sigmoid_observer.mean, trial.tetrahedral.mean});
}

/// One line a trial: by how much learning is nearer, or not.
std::string verdict(const LearningTrial& trial) {
  const std::string of = trial.held_out.empty() ? std::string("materials like these")
                                                : "materials of another origin, as " + trial.held_out;
  if (!trial.pays()) {
    return fmt::format("for {} learning does not pay: {:.3f}, where a method without it has {:.3f}", of,
                       trial.learned.mean, best_other(trial));
  }
  return fmt::format("for {} learning pays: {:.0f} % less than the best method without it", of,
                     100 * (1 - trial.learned.mean / best_other(trial)));
}

/// The reason why there are no errors.
std::string unevaluated(const LearningTrial& trial) {
  if (!trial.held_out.empty() && trial.learned_from < kMinReflectances)
    return fmt::format("not evaluated, as the others are only {} reflectances", trial.learned_from);
  return "not evaluated, as none is inside sRGB";
}

void print_report(const std::vector<LearningTrial>& trials) {
  print("  {:<44} {:>7} {:>7} {:>7}\n", "CIEDE2000 under A, FL2, FL11, LED-B3, HP1", "mean", "95 %",
        "maximum");
  for (const LearningTrial& trial : trials) {
    if (trial.reflectances == 0) {
      print("  held out: {}: {}\n", held_out(trial), unevaluated(trial));
      continue;
    }
    print("  held out: {} ({} inside sRGB)\n", held_out(trial), trial.reflectances);
    for (const auto& [name, error] : methods_of(trial)) {
      print("    {:<42} {:>7.3f} {:>7.3f} {:>7.3f}\n", name, error->mean, error->percentile95,
            error->maximum);
    }
  }
  for (const LearningTrial& trial : trials) {
    if (trial.reflectances > 0) print("  {}\n", verdict(trial));
  }
}

nlohmann::ordered_json report_json(const FitArguments& a, const Materials& materials,
                                   const std::vector<LearningTrial>& trials) {
  nlohmann::ordered_json out = {{"output", a.output},
                                {"reflectances", materials.count},
                                {"measure", "CIEDE2000 under A, FL2, FL11, LED-B3, HP1, held out"},
                                {"trials", nlohmann::ordered_json::array()}};
  for (const LearningTrial& trial : trials) {
    nlohmann::ordered_json one = {{"held_out", held_out(trial)}, {"reflectances", trial.reflectances}};
    if (trial.reflectances == 0) {
      one["why"] = unevaluated(trial);
      out["trials"].push_back(std::move(one));
      continue;
    }
    for (const auto& [name, error] : methods_of(trial)) {
      one[name] = {{"mean", error->mean}, {"percentile95", error->percentile95}, {"maximum", error->maximum}};
    }
    one["pays"] = trial.pays();
    out["trials"].push_back(std::move(one));
  }
  if (!materials.notes.empty()) out["notes"] = materials.notes;
  return out;
}

int run_fit(const FitArguments& a) {
  apply_common(a.common);
  std::vector<NamedFile> read = named_files(a.reflectances, kReflectancesRole);
  read.push_back({a.white, "the reference white (--white)"});
  check_outputs({{a.output, kOutputRole}}, files_among(read));
  std::set<std::string> named;
  for (const std::string& file : a.reflectances) {
    if (!named.insert(file).second) return complain_usage(fmt::format("--reflectances names {} twice", file));
  }
  catch_signals();
  LearningOptions options;
  options.observer = a.white_observer;
  options.go_on = [] { return !interrupted(); };
  if (!a.white.empty()) {
    SpectrumFileOptions of_light = file_options(a.spectra);
    of_light.one.reset();  // of reflectances
    options.light = take(find_light(a.white, of_light));
  }
  const Materials materials = materials_of(a);
  print_notes(a.common, materials.notes);
  const auto start = std::chrono::steady_clock::now();
  const auto trials = take(try_learning(materials.sets, options));
  const LearnedNodes nodes = take(learn_nodes(materials.sets, options));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (interrupted()) return complain({ErrorCode::kCancelled, "stopped on request"});
  take(save_nodes(nodes, a.output));
  if (a.common.json) {
    print_verbatim(report_json(a, materials, trials)
                       .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                   "\n");
  } else if (!a.common.quiet) {
    print("{}: learned from {} reflectances, {:.1f} s\n", a.output, materials.count, seconds.count());
    print_report(trials);
  }
  return kOk;
}

}  // namespace

void add_fit(const Command& app, int& exit) {
  const auto [command, a] = add_subcommand(
      app, "fit", "Learn from measured reflectances what upsampling should make of colours", run_fit, exit);
  command.output_file("-o,--output", a->output, kFilesGroup, "Nodes to write, as JSON").required();
  command
      .option("--reflectances", a->reflectances, "FILE", kFilesGroup,
              "Reflectances of measured materials; repeat it for files of different origin")
      .required();
  command.option("--white", a->white, "SPECTRUM", kColorGroup,
                 "Reference white that upsampling will have; D65 by default");
  add_observer_option(command, a->white_observer, "--white-observer");
  add_spectrum_options(command, a->spectra);
  add_values_option(command, a->spectra);
  add_common(command, a->common,
             "spectile fit --reflectances paints.csv -o nodes.json\n"
             "  spectile upsample wood.exr -o out.exr --method tetrahedral --nodes nodes.json\n" +
                 kSpectrumHelp);
}

}  // namespace spectile::cli
