// A limit on the memory that a run takes.
#include "src/cli/options/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <thread>

namespace spectile::cli {
namespace {

/// Bytes that the control group of this process may take, where one is limited and visible.
std::optional<double> group_limit() {
  for (const char* path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::ifstream file(path);
    double bytes = 0;
    if (file >> bytes) return bytes;  // "max" is no number
  }
  return {};
}

double machine_memory() {
  const double bytes =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return std::min(bytes, group_limit().value_or(bytes));
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
