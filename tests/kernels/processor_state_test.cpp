// Kernels leave the processor as they found it: no wide registers in use, which would slow down their
// callers' scalar code many times over, and no rounding or flushing of another kind.
#include <gtest/gtest.h>

#include <vector>

#include "bench/operations/lane_memory.hpp"
#include "bench/operations/operation.hpp"
#include "src/dispatch/dispatch.hpp"
#include "tests/support/lanes.hpp"

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace spectile::test {
namespace {

#if defined(__x86_64__)

/// True if XGETBV tells which registers are in use. Source: Intel 64 and IA-32 Architectures Software
/// Developer's Manual, volume 1, 13.6.
bool tells_registers_in_use() {
  unsigned a = 0;
  unsigned b = 0;
  unsigned c = 0;
  unsigned d = 0;
  return __get_cpuid_count(0xD, 1, &a, &b, &c, &d) != 0 && (a & 4U) != 0;
}

/// Upper parts of the 256-bit registers (bit 2) and of the first sixteen 512-bit ones (bit 6).
__attribute__((target("xsave"))) unsigned upper_parts_in_use() {
  return static_cast<unsigned>(_xgetbv(1)) & 0x44U;
}
__attribute__((target("avx"))) void clear_upper_parts() {
  _mm256_zeroupper();
}
__attribute__((target("avx"))) void use_upper_parts() {
  const __m256 ones = _mm256_set1_ps(1.0F);
  __asm__ volatile("" : : "x"(ones));
}

TEST(KernelState, NoWideRegistersAreLeftInUse) {
  if (!tells_registers_in_use() || !__builtin_cpu_supports("avx"))
    GTEST_SKIP() << "the processor does not tell";
  use_upper_parts();
  clear_upper_parts();
  ASSERT_EQ(upper_parts_in_use(), 0U);
  const auto operations = measure::lane_operations(Bands());
  ASSERT_TRUE(operations) << operations.error().message;
  constexpr std::size_t kBlocks = 4;
  for (const kernels::KernelTable* table : dispatch::available()) {
    for (const measure::Operation& op : *operations) {
      auto memory = *FloatBuffer::create(measure::LaneMemory::min_bytes(op, kBlocks) / sizeof(float) + 1);
      measure::LaneMemory lanes(op, memory.data(), measure::LaneMemory::min_bytes(op, kBlocks));
      measure::Random random(1);
      std::vector<float> values(op.in.values());
      for (std::size_t lane = 0; lane < lanes.lanes(); ++lane) {
        op.fill(random, values.data());
        lanes.write(lane, values.data());
      }
      for (const bool non_temporal : {false, true}) {
        const measure::Arrays arrays = lanes.arrays(0, lanes.blocks(), non_temporal);
        const unsigned mode = __builtin_ia32_stmxcsr() & 0xFFC0U;
        clear_upper_parts();
        op.run(*table, arrays);
        EXPECT_EQ(upper_parts_in_use(), 0U) << table->name << " " << op.name;
        EXPECT_EQ(__builtin_ia32_stmxcsr() & 0xFFC0U, mode) << table->name << " " << op.name;
      }
    }
  }
}

#endif

}  // namespace
}  // namespace spectile::test
