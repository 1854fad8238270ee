// The fixture of tests that hold one instruction set's kernels to the reference's bits.
#pragma once

#include <gtest/gtest.h>

#include "kernels/abi.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/reference/table.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {

/// Every table there is beside the reference; those that do not run here skip, visibly.
class KernelTest : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    for (const kernels::KernelTable* table : dispatch::available()) {
      if (std::string(table->name) == GetParam()) k_ = table;
    }
    if (k_ == nullptr) GTEST_SKIP() << GetParam() << " does not run on this machine";
    ASSERT_NE(k_, &reference::kKernelTable);
    ASSERT_GT(k_->lanes, 1);
  }
  const kernels::KernelTable& k() const { return *k_; }
  static const kernels::KernelTable& ref() { return reference::kKernelTable; }

 private:
  const kernels::KernelTable* k_ = nullptr;
};

inline std::string kernel_name(const testing::TestParamInfo<const char*>& info) {
  return test_name(info.param);
}

}  // namespace spectile::test

#define SPECTILE_FOR_EVERY_ISA(Suite) \
  INSTANTIATE_TEST_SUITE_P(EveryIsa, Suite, testing::Values("sse4.2", "avx2", "avx512", "neon"), kernel_name)
