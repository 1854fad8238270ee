// End to end: `spectile upsample` of a large texture against what OpenEXR alone takes to write the same
// planes.
//
// usage: spectile_bench_end_to_end TOOL FOLDER SIZE RUNS THREADS [IMAGE]
//
// The texture is IMAGE repeated over SIZE x SIZE pixels, or a procedural one. For each compression, runs
// alternate between the tool (whole process: start, reading, arithmetic, encoding, writing) and OpenEXR's C++
// library with as many threads (from planes in memory, touched before, to a closed file). Medians, their
// ratio, and the tool's peak memory are printed. SPECTILE_BENCH_COMPRESSION=NAME measures one compression
// only.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/micro/noise_texture.hpp"
#include "bench/micro/or_exit.hpp"

namespace {

namespace fs = std::filesystem;
using bench::median;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One channel's samples in memory.
struct Plane {
  std::string name;
  std::vector<half> samples;
};

void write_planes(const std::string& path, int width, int height, std::vector<Plane>& planes,
                  Imf::Compression method, int zip_level) {
  Imf::Header header(width, height);
  header.compression() = method;
  if (zip_level > 0) header.zipCompressionLevel() = zip_level;
  Imf::FrameBuffer source;
  for (Plane& plane : planes) {
    header.channels().insert(plane.name, Imf::Channel(Imf::HALF));
    source.insert(plane.name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(plane.samples.data()),
                                         sizeof(half), sizeof(half) * static_cast<std::size_t>(width)));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(source);
  file.writePixels(height);
}

std::vector<Plane> read_planes(const std::string& path, int& width, int& height) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  width = window.max.x - window.min.x + 1;
  height = window.max.y - window.min.y + 1;
  std::vector<Plane> planes;
  for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
    planes.push_back(
        {it.name(), std::vector<half>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))});
  }
  Imf::FrameBuffer target;
  for (Plane& plane : planes) {
    target.insert(plane.name, Imf::Slice::Make(Imf::HALF, plane.samples.data(), window));
  }
  file.setFrameBuffer(target);
  file.readPixels(window.min.y, window.max.y);
  return planes;
}

void make_texture(const std::string& path, int size, const std::string& image) {
  const auto n = static_cast<std::size_t>(size);
  std::vector<Plane> planes = {
      {"R", std::vector<half>(n * n)}, {"G", std::vector<half>(n * n)}, {"B", std::vector<half>(n * n)}};
  int w = 0;
  int h = 0;
  std::vector<Plane> tile;
  if (!image.empty()) tile = read_planes(image, w, h);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto source =
        std::find_if(tile.begin(), tile.end(), [&](const Plane& p) { return p.name == planes[k].name; });
    for (std::size_t y = 0; y < n; ++y) {
      for (std::size_t x = 0; x < n; ++x) {
        half& out = planes[k].samples[y * n + x];
        if (source != tile.end()) {
          out = source->samples[(y % static_cast<std::size_t>(h)) * static_cast<std::size_t>(w) +
                                x % static_cast<std::size_t>(w)];
          continue;
        }
        out = half(static_cast<float>(bench::texture(x, y, k)));
      }
    }
  }
  write_planes(path, size, size, planes, Imf::ZIP_COMPRESSION, 0);
}

/// Runs the tool; wall seconds and peak memory in MB.
struct ToolRun {
  double seconds;
  double peak_mb;
};

/// Starts the tool from a small process of its own: a child's peak memory begins with its parent's.
class Runner {
 public:
  Runner() {
    int request[2];
    int answer[2];
    if (pipe(request) != 0 || pipe(answer) != 0) std::exit(1);
    if (fork() == 0) {
      close(request[1]);
      close(answer[0]);
      serve(request[0], answer[1]);
    }
    close(request[0]);
    close(answer[1]);
    request_ = request[1];
    answer_ = answer[0];
  }

  /// Runs a command whose words hold no line breaks.
  ToolRun run(const std::vector<std::string>& command) {
    std::string text;
    for (const std::string& word : command) text += word + '\n';
    text += '\n';
    ToolRun result{};
    if (write(request_, text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
        read(answer_, &result, sizeof(result)) != static_cast<ssize_t>(sizeof(result)) ||
        result.seconds < 0) {
      fmt::print(stderr, "{} failed\n", command[0]);
      std::exit(1);
    }
    return result;
  }

 private:
  [[noreturn]] static void serve(int request, int answer) {
    std::vector<std::string> words(1);
    for (char c = 0; read(request, &c, 1) == 1;) {
      if (c != '\n') {
        words.back() += c;
      } else if (!words.back().empty()) {
        words.emplace_back();
      } else {
        words.pop_back();
        const ToolRun result = once(words);
        if (write(answer, &result, sizeof(result)) < 0) break;
        words.assign(1, "");
      }
    }
    _exit(0);
  }

  static ToolRun once(std::vector<std::string>& words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const auto start = Clock::now();
    const pid_t child = fork();
    if (child == 0) {
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    int status = 0;
    struct rusage usage {};
    wait4(child, &status, 0, &usage);
    const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return {good ? since(start) : -1, static_cast<double>(usage.ru_maxrss) * 1024e-6};
  }

  int request_ = -1;
  int answer_ = -1;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    fmt::print(stderr, "usage: {} TOOL FOLDER SIZE RUNS THREADS [IMAGE]\n", argv[0]);
    return 2;
  }
  Runner runner;
  const std::string tool = argv[1];
  const fs::path folder = argv[2];
  const int size = std::atoi(argv[3]);
  const int runs = std::atoi(argv[4]);
  const std::string threads = argv[5];
  const std::string texture = (folder / "texture.exr").string();
  const std::string planes_file = (folder / "planes.exr").string();
  const std::string ours = (folder / "ours.exr").string();
  const std::string theirs = (folder / "theirs.exr").string();
  fs::create_directories(folder);
  Imf::setGlobalThreadCount(std::atoi(threads.c_str()));
  make_texture(texture, size, argc > 6 ? argv[6] : "");
  runner.run({tool, "upsample", texture, "-o", planes_file, "--compression", "none", "--quiet"});
  int width = 0;
  int height = 0;
  std::vector<Plane> planes = read_planes(planes_file, width, height);
  fs::remove(planes_file);
  fmt::print("{} x {} pixels, {} planes of half, {} threads, {}; medians of {} runs each, alternating\n\n",
             width, height, planes.size(), threads,
             argc > 6 ? fs::path(argv[6]).filename().string() + " repeated" : "procedural texture", runs);
  fmt::print("{:<8} {:>12} {:>12} {:>7} {:>22} {:>10} {:>12}\n", "", "spectile, s", "OpenEXR, s", "ratio",
             "spectile, Mpixel/s", "size, MB", "peak, MB");
  const struct {
    const char* name;
    Imf::Compression method;
    int level;
  } methods[] = {{"none", Imf::NO_COMPRESSION, 0},
                 {"piz", Imf::PIZ_COMPRESSION, 0},
                 {"zip:1", Imf::ZIP_COMPRESSION, 1},
                 {"zip:4", Imf::ZIP_COMPRESSION, 4}};
  bool met = true;
  const char* const only = std::getenv("SPECTILE_BENCH_COMPRESSION");
  for (const auto& method : methods) {
    if (only != nullptr && std::string(only) != method.name) continue;
    std::vector<double> tool_seconds;
    std::vector<double> library_seconds;
    double peak = 0;
    double bytes = 0;
    for (int run = 0; run < runs; ++run) {
      const ToolRun r = runner.run({tool, "upsample", texture, "-o", ours, "--compression", method.name,
                                    "--threads", threads, "--quiet"});
      tool_seconds.push_back(r.seconds);
      peak = std::max(peak, r.peak_mb);
      bytes = static_cast<double>(fs::file_size(ours));
      fs::remove(ours);
      const auto start = Clock::now();
      write_planes(theirs, width, height, planes, method.method, method.level);
      library_seconds.push_back(since(start));
      fs::remove(theirs);
    }
    const double a = median(tool_seconds);
    const double b = median(library_seconds);
    const bool good = a / b <= 1.15 && peak < 400;
    met = met && good;
    fmt::print("{:<8} {:>12.2f} {:>12.2f} {:>7.2f} {:>22.2f} {:>10.0f} {:>12.0f}  {}\n", method.name, a, b,
               a / b, width * 1e-6 * height / a, bytes * 1e-6, peak, good ? "met" : "MISSED");
    std::fflush(stdout);
  }
  fmt::print("\ntarget: ratio at most 1.15, peak under 400 MB\n");
  fs::remove(texture);
  return met ? 0 : 1;
}
