// Detection of the processor's instruction sets and choice of the kernel table.
#include "src/dispatch/dispatch.hpp"

#include <atomic>
#include <cstdlib>
#include <spectile/isa.hpp>
#include <string>

#include "src/base/errors.hpp"
#include "src/reference/table.hpp"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace spectile {
namespace kernels::sse42 {
extern const KernelFamilies families;
}
namespace kernels::avx2 {
extern const KernelFamilies families;
}
namespace kernels::avx512 {
extern const KernelFamilies families;
}
namespace kernels::neon {
extern const KernelFamilies families;
}

namespace dispatch {
namespace {

using kernels::KernelTable;

#if defined(__x86_64__)
// F16C; the operating system's part is covered by the test for AVX2 that always goes with it.
bool has_f16c() {
  unsigned registers[4] = {};
  auto& [a, b, c, d] = registers;
  return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & (1U << 29)) != 0;
}
// The compiler's builtins also ask whether the operating system saves the registers (XCR0).
bool runs_sse42() {
  return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
}
bool runs_avx2() {
  return runs_sse42() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && has_f16c();
}
bool runs_avx512() {
  return runs_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}
#endif

/// The table of one instruction set, put together here: code of the kernels' units may not run on this
/// machine.
template <const kernels::KernelFamilies& kFamilies>
const KernelTable* joined() {
  static const KernelTable table = {*kFamilies.arithmetic,  *kFamilies.color, *kFamilies.upsampling,
                                    *kFamilies.wavelengths, *kFamilies.film,  *kFamilies.texture,
                                    kFamilies.name,         kFamilies.lanes};
  return &table;
}

struct Entry {
  std::string_view name;
  bool (*runs)();  // null: not in this build
  const KernelTable* (*table)();
};

constexpr Entry kEntries[] = {
    {"scalar", [] { return true; }, [] { return &reference::kKernelTable; }},
#if defined(__x86_64__)
    {"sse4.2", runs_sse42, joined<kernels::sse42::families>},
    {"avx2", runs_avx2, joined<kernels::avx2::families>},
    {"avx512", runs_avx512, joined<kernels::avx512::families>},
#else
    {"sse4.2", nullptr, nullptr},
    {"avx2", nullptr, nullptr},
    {"avx512", nullptr, nullptr},
#endif
#if defined(__aarch64__)
    {"neon", [] { return true; }, joined<kernels::neon::families>},
#else
    {"neon", nullptr, nullptr},
#endif
};

std::atomic<const KernelTable*> override_table{nullptr};

std::string names_here() {
  return fmt::format("{}", fmt::join(available_isas(), ", "));
}

}  // namespace

std::vector<const KernelTable*> available() {
  std::vector<const KernelTable*> tables;
  for (const Entry& entry : kEntries) {
    if (entry.runs != nullptr && entry.runs()) tables.push_back(entry.table());
  }
  return tables;
}

Result<const KernelTable*> find(std::string_view name) {
  for (const Entry& entry : kEntries) {
    if (entry.name != name) continue;
    if (entry.runs != nullptr && entry.runs()) return entry.table();
    return make_error(ErrorCode::kUnavailable,
                      "instruction set \"{}\" does not run on this machine, which has {}", name,
                      names_here());
  }
  return make_error(ErrorCode::kUnknownName, "instruction set \"{}\" is unknown; this machine has {}", name,
                    names_here());
}

Result<const KernelTable*> active() {
  if (const KernelTable* table = override_table.load(std::memory_order_acquire)) return table;
  static const Result<const KernelTable*> chosen = []() -> Result<const KernelTable*> {
    const char* name = std::getenv("SPECTILE_ISA");
    if (name == nullptr || *name == '\0') return available().back();
    auto table = find(name);
    if (!table) return make_error(table.error().code, "SPECTILE_ISA: {}", table.error().message);
    return table;
  }();
  return chosen;
}

Result<void> force(std::string_view name) {
  if (name.empty()) {
    override_table.store(nullptr, std::memory_order_release);
    return {};
  }
  SPECTILE_ASSIGN(const auto table, find(name));
  override_table.store(table, std::memory_order_release);
  return {};
}

}  // namespace dispatch

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const kernels::KernelTable* table : dispatch::available()) names.emplace_back(table->name);
  return names;
}

Result<std::string> active_isa() {
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  return std::string(table->name);
}

Result<void> force_isa(std::string_view name) {
  return dispatch::force(name);
}

}  // namespace spectile
