// What every subcommand shares: options, exit codes, messages, the progress bar.
#include "src/cli/common.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "src/cli/batch.hpp"

namespace spectile::cli {
namespace {

volatile std::sig_atomic_t signal_seen = 0;

extern "C" void note_signal(int) {
  signal_seen = 1;
}

int usage(const std::string& message) {
  fmt::print(stderr, "spectile: {}\n", message);
  return kBadUsage;
}

/// A bar on stderr, redrawn ten times a second at most; nothing where stderr is no terminal.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool enabled)
      : label_(std::move(label)), shown_(enabled && ::isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() {
    if (drawn_) fmt::print(stderr, "\r\033[K");
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  bool update(const Progress& progress) {
    if (interrupted()) return false;
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now - last_ < std::chrono::milliseconds(100)) return true;
    last_ = now;
    drawn_ = true;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double done = static_cast<double>(progress.pixels_done) / static_cast<double>(progress.pixels);
    constexpr int kWidth = 30;
    const int full = static_cast<int>(done * kWidth);
    fmt::print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {:3.0f} %  {}  {:.0f} s left", label_, "", full, "",
               kWidth - full, 100 * done, speed_text(progress.pixels_done, seconds),
               seconds / done * (1 - done));
    static_cast<void>(std::fflush(stderr));
    return true;
  }

 private:
  std::string label_;
  bool shown_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = start_ - std::chrono::seconds(1);
};

nlohmann::json to_json(const Job& job, const ImageReport& r) {
  return {{"input", job.input},
          {"output", job.output},
          {"width", r.width},
          {"height", r.height},
          {"bands", r.bands},
          {"quantity", to_string(r.quantity)},
          {"color_space", r.color_space},
          {"nonfinite_pixels", r.nonfinite_pixels},
          {"negative_pixels", r.negative_pixels},
          {"over_one_pixels", r.over_one_pixels},
          {"out_of_gamut_pixels", r.out_of_gamut_pixels},
          {"clamped_pixels", r.clamped_pixels},
          {"bytes_written", r.bytes_written},
          {"seconds", r.seconds},
          {"skipped",
           {{"masked_pixels", r.skipped.masked_pixels},
            {"black_pixels", r.skipped.black_pixels},
            {"constant_pixels", r.skipped.constant_pixels},
            {"chunks", r.skipped.chunks},
            {"chunks_reused", r.skipped.chunks_reused},
            {"colors_looked_up", r.skipped.colors_looked_up},
            {"colors_solved", r.skipped.colors_solved},
            {"core_seconds_saved", r.skipped.core_seconds_saved}}},
          {"mpixel_per_s", static_cast<double>(r.pixels()) / r.seconds * 1e-6},
          {"notes", r.notes}};
}

void print_json(const nlohmann::json& json) {
  fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string plural(std::uint64_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

void print_skipped(const SkipStats& s) {
  fmt::print("  skipped: {} masked, {} black, {} in blocks of one colour\n", plural(s.masked_pixels, "pixel"),
             s.black_pixels, s.constant_pixels);
  fmt::print("  {} of {} used again\n", s.chunks_reused, plural(s.chunks, "chunk"));
  if (s.colors_looked_up > 0) {
    fmt::print("  {} looked up, {} of them solved\n", plural(s.colors_looked_up, "colour"), s.colors_solved);
  }
  fmt::print("  about {:.2f} s of one core saved\n", s.core_seconds_saved);
}

void print_report(const Job& job, const ImageReport& r, bool stats) {
  fmt::print("{} -> {}: {} x {}, {}, {}, {}, {:.2f} s\n", job.input, job.output, r.width, r.height,
             plural(r.bands, "band"), size_text(r.bytes_written), speed_text(r.pixels(), r.seconds),
             r.seconds);
  if (!r.color_space.empty()) fmt::print("  RGB taken for {}\n", r.color_space);
  if (r.nonfinite_pixels > 0) fmt::print("  {} made black\n", plural(r.nonfinite_pixels, "non-finite pixel"));
  if (r.negative_pixels > 0) {
    fmt::print("  {} with a component below 0\n", plural(r.negative_pixels, "pixel"));
  }
  if (r.over_one_pixels > 0 && r.quantity == Quantity::kReflectance && !r.color_space.empty()) {
    fmt::print("  {} above 1, which no real reflectance is\n", plural(r.over_one_pixels, "pixel"));
  }
  if (r.out_of_gamut_pixels > 0) {
    fmt::print("  {} outside the method's gamut\n", plural(r.out_of_gamut_pixels, "pixel"));
  }
  if (r.clamped_pixels > 0) {
    fmt::print("  {} beyond the range of half, limited to 65504; --pixel float keeps them\n",
               plural(r.clamped_pixels, "pixel"));
  }
  for (const std::string& note : r.notes) fmt::print("  {}\n", note);
  if (stats) print_skipped(r.skipped);
}

}  // namespace

void add_common(CLI::App& command, Common& common) {
  command.add_option("--threads", common.threads, "Threads to use; 0 for every core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command.add_option("--isa", common.isa,
                     "Instruction set: scalar, sse4.2, avx2, avx512 or neon; the fastest by default. "
                     "The results are the same to the bit");
  command.add_flag("--json", common.json, "Print one JSON object a line instead of text");
  command.add_flag("--quiet", common.quiet, "Print nothing but errors");
}

int apply_common(const Common& common) {
  if (!common.isa.empty()) {
    if (auto forced = force_isa(common.isa); !forced) return complain(forced.error());
  }
  if (auto isa = active_isa(); !isa) return complain(isa.error());
  return kOk;
}

int complain(const Error& error) {
  fmt::print(stderr, "spectile: {}\n", error.message);
  switch (error.code) {
    case ErrorCode::kNoSpace:
    case ErrorCode::kNoPermission:
      return kNoRoom;
    case ErrorCode::kBadArgument:
    case ErrorCode::kUnknownName:
    case ErrorCode::kUnavailable:
      return kBadUsage;
    case ErrorCode::kCancelled:
      return kInterrupted;
    default:
      return kBadInput;
  }
}

void add_write_options(CLI::App& command, WriteOptions& options, const char* pixel_default) {
  command
      .add_option("--pixel", options.pixel,
                  fmt::format("Sample type: half or float; {} by default", pixel_default))
      ->check(CLI::IsMember({"half", "float"}));
  command.add_option(
      "--compression", options.compression,
      fmt::format("none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab; zip and zips take a level "
                  "of 1 (fast) to 9 (small), as in zip:4, dwaa and dwab one of loss, 45 by default; {} "
                  "by default. b44 and b44a lose precision, pxr24 does with float, dwaa and dwab do in "
                  "R, G, B, Y and A",
                  Compression{}.description()));
  command
      .add_option("--nonfinite", options.nonfinite,
                  "Pixels with NaN or infinity: stop (no output is written) or zero (they become black)")
      ->check(CLI::IsMember({"stop", "zero"}))
      ->capture_default_str();
  command
      .add_option("--tile", options.tile,
                  "Width and height of tiles, 1 to 4096 each, for renderers that read parts of images; "
                  "scanlines by default")
      ->expected(2)
      ->check(CLI::Range(1, 4096));
  command.add_flag(
      "--mipmap", options.mipmap,
      "Write mip levels down to one pixel too, for renderers that filter textures: each pixel the "
      "average of the area that it covers, of spectra or of linear colours; in tiles of 64 x 64 "
      "where --tile says nothing");
  command.add_option("--lanes", options.lanes, "Most pixels a kernel call works on; changes speed only")
      ->check(CLI::Range(std::size_t{64}, std::size_t{1} << 30))
      ->capture_default_str();
}

int apply_write_options(const WriteOptions& options, const Common& common, ImageOptions& out) {
  out.threads = common.threads;
  out.tile_lanes = options.lanes;
  if (!options.tile.empty()) out.tile = {options.tile[0], options.tile[1]};
  out.mipmap = options.mipmap;
  if (!options.pixel.empty()) out.pixel = options.pixel == "float" ? PixelType::kFloat : PixelType::kHalf;
  out.nonfinite = options.nonfinite == "zero" ? NonFinite::kZero : NonFinite::kStop;
  if (!options.compression.empty()) {
    const auto compression = Compression::parse(options.compression);
    if (!compression) return complain(compression.error());
    out.compression = *compression;
  }
  return kOk;
}

int plan_jobs(const std::vector<std::string>& inputs, const std::string& output, std::vector<Job>& jobs) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  bool directory = fs::is_directory(output, ignored);
  if (!directory && (inputs.size() > 1 || output.ends_with('/'))) {
    std::error_code error;
    fs::create_directories(output, error);
    if (error || !fs::is_directory(output, ignored)) {
      fmt::print(stderr, "spectile: {}: cannot be made a directory{}{}\n", output, error ? ": " : "",
                 error ? error.message() : "");
      return error == std::errc::permission_denied || error == std::errc::no_space_on_device ||
                     error == std::errc::read_only_file_system
                 ? kNoRoom
                 : kBadUsage;
    }
    directory = true;
  }
  std::set<std::string> taken;
  for (const std::string& input : inputs) {
    std::string target = directory ? (fs::path(output) / fs::path(input).filename()).string() : output;
    if (!taken.insert(target).second) {
      return usage(fmt::format("{}: two inputs would be written there", target));
    }
    jobs.push_back({input, std::move(target)});
  }
  return kOk;
}

Result<void> check_output(const std::string& output, const std::vector<std::string>& made_from) {
  for (const std::string& file : made_from) {
    std::error_code error;
    if (!std::filesystem::equivalent(file, output, error) || error) continue;
    return Error{ErrorCode::kBadArgument,
                 fmt::format("{}: the output is {}, which it is made from", output, file)};
  }
  return {};
}

int run_jobs(const Batch& batch, const Common& common, ImageOptions& options,
             const std::function<Result<ImageReport>(const Job&)>& convert) {
  int exit = kOk;
  std::size_t skipped = 0;
  std::size_t converted = 0;
  catch_signals();
  const bool talks = !common.quiet && !common.json;
  if (batch.shard && talks) {
    fmt::print("shard {}: {} of {}\n", batch.shard->text(), batch.jobs.size(), plural(batch.inputs, "input"));
  }
  for (const Job& job : batch.jobs) {
    if (is_up_to_date(batch, job)) {
      ++skipped;
      if (talks) fmt::print("{} -> {}: up to date\n", job.input, job.output);
      if (common.json) print_json({{"input", job.input}, {"output", job.output}, {"skipped", true}});
      if (const int bad = batch.manifest.add(skipped_line(batch, job))) return bad;
      if (interrupted()) return kInterrupted;
      continue;
    }
    auto report = [&]() -> Result<ImageReport> {
      if (const auto good = check_output(job.output, batch.made_from); !good) return good.error();
      ProgressBar bar(std::filesystem::path(job.input).filename().string(), !common.quiet);
      options.progress = [&bar](const Progress& progress) { return bar.update(progress); };
      auto result = convert(job);
      options.progress = nullptr;
      return result;
    }();
    if (!report) {
      exit = std::max(exit, complain(report.error()));
      if (common.json) {
        print_json({{"input", job.input}, {"output", job.output}, {"error", report.error().message}});
      }
      if (const int bad = batch.manifest.add(failed_line(batch, job, report.error()))) return bad;
      if (interrupted()) return kInterrupted;
      continue;
    }
    ++converted;
    if (common.json) {
      print_json(to_json(job, *report));
    } else if (!common.quiet) {
      print_report(job, *report, common.stats);
    }
    if (const int bad = batch.manifest.add(converted_line(batch, job, *report))) return bad;
  }
  if (batch.update && talks) {
    const std::size_t failed = batch.jobs.size() - converted - skipped;
    fmt::print("{} converted, {} up to date{}\n", converted, skipped,
               failed > 0 ? fmt::format(", {} failed", failed) : "");
  }
  return exit;
}

std::string speed_text(std::uint64_t pixels, double seconds) {
  return fmt::format("{:.3g} Mpixel/s", static_cast<double>(pixels) / std::max(seconds, 1e-9) * 1e-6);
}

std::string size_text(std::uint64_t bytes) {
  constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000 && unit + 1 < std::size(kUnits); ++unit) value /= 1000;
  return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

ProgressFunction progress_bar(const std::string& label, bool enabled) {
  const auto bar = std::make_shared<ProgressBar>(label, enabled);
  return [bar](const Progress& progress) { return bar->update(progress); };
}

bool interrupted() {
  return signal_seen != 0;
}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  sigemptyset(&action.sa_mask);
  // A second signal ends the process at once.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace spectile::cli
