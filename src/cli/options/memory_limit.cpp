// A limit on the memory that a run takes.
#include "src/cli/options/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace spectile::cli {
namespace {

/// The least of `bytes` and of what a control group and those above it may take. Source: Linux, cgroups(7).
double least_of_groups(double bytes, const std::string& root, std::filesystem::path group,
                       const char* limit) {
  // Within a container its own group is the root's.
  for (bool more = true; more; group = group.parent_path()) {
    more = group.has_relative_path();
    std::ifstream file(root + (more ? group.string() : "") + "/" + limit);
    double most = 0;
    if (file >> most) bytes = std::min(bytes, most);  // "max" is no number
  }
  return bytes;
}

double machine_memory() {
  double bytes =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (line.starts_with("0::")) {
      bytes = least_of_groups(bytes, "/sys/fs/cgroup", line.substr(3), "memory.max");
    } else if (const std::size_t at = line.find(":memory:"); at != std::string::npos) {
      bytes = least_of_groups(bytes, "/sys/fs/cgroup/memory", line.substr(at + 8), "memory.limit_in_bytes");
    }
  }
  return bytes;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // whose own memory is beyond any limit
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

}  // namespace

void limit_memory(std::optional<double> gigabytes, int threads) {
  const double wanted = gigabytes ? *gigabytes * 1e9 : machine_memory();
  rlimit limit{};
  if (kSanitized || wanted <= 0 || ::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const double count = threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
  // Two for each: a kernel's and a decoder's. The limit counts a stack as a whole.
  constexpr double kStackBytes = 8.0 * 1024 * 1024;
  const double bytes = wanted + 2 * count * kStackBytes;
  if (bytes >= static_cast<double>(limit.rlim_cur)) return;
  limit.rlim_cur = static_cast<rlim_t>(bytes);
  static_cast<void>(::setrlimit(RLIMIT_DATA, &limit));
}

}  // namespace spectile::cli
