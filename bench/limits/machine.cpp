// Description of the machine: processor, caches, system, compiler.
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <spectile/isa.hpp>

#include "bench/limits/limits.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile::measure {
namespace {

/// The first "key : value" of /proc/cpuinfo with that key.
std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || colon + 2 >= line.size()) break;
    return line.substr(colon + 2);
  }
  return "unknown";
}

std::uint64_t cache_size(int name) {
  return static_cast<std::uint64_t>(std::max(0L, ::sysconf(name)));
}

std::string compiler_name() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#elif defined(__GNUC__)
  return "GCC " __VERSION__;
#else
  return "unknown";
#endif
}

}  // namespace

BenchmarkMachine describe_machine() {
  BenchmarkMachine out;
  utsname system{};
  const bool known = ::uname(&system) == 0;
  out.processor = processor_name();
  if (out.processor == "unknown" && known) out.processor = system.machine;
  out.system = known ? std::string(system.sysname) + " " + system.release : "unknown";
  out.compiler = compiler_name();
  out.version = SPECTILE_VERSION;
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  char text[32] = "";
  if (::gmtime_r(&now, &utc) != nullptr &&
      std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &utc) > 0) {
    out.date = text;
  }
  out.cores = tiles::thread_count(0);
#if defined(_SC_LEVEL2_CACHE_SIZE)
  out.second_level_cache = cache_size(_SC_LEVEL2_CACHE_SIZE);
  out.last_level_cache = std::max(cache_size(_SC_LEVEL3_CACHE_SIZE), cache_size(_SC_LEVEL4_CACHE_SIZE));
#endif
  for (const std::string& isa : available_isas()) {
    if (isa != "scalar") out.isas.push_back(isa);
  }
  return out;
}

}  // namespace spectile::measure
