// The loops that find a machine's limits do what they say: the reference's bits on every instruction set.
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

class LimitKernels : public KernelTest {
 protected:
  static constexpr std::size_t kCount = 2 * kernels::kLimitChains;
  void SetUp() override {
    KernelTest::SetUp();
    src_ = *FloatBuffer::create(kCount);
    mine_ = *FloatBuffer::create(kCount);
    theirs_ = *FloatBuffer::create(kCount);
    for (std::size_t i = 0; i < kCount; ++i) src_.data()[i] = 0.1F + 0.01F * static_cast<float>(i);
  }
  void expect_same() const {
    for (std::size_t i = 0; i < kCount; ++i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(mine_.data()[i]),
                std::bit_cast<std::uint32_t>(theirs_.data()[i]))
          << i;
    }
  }
  FloatBuffer src_, mine_, theirs_;
};

TEST_P(LimitKernels, LoadsSeeEveryNumber) {
  std::uint32_t mine[kernels::kLanes];
  std::uint32_t theirs[kernels::kLanes];
  for (const std::size_t changed : {std::size_t{0}, std::size_t{63}, kCount - 1}) {
    src_.data()[changed] += 1;
    k().limit_load(mine, src_.data(), kCount);
    ref().limit_load(theirs, src_.data(), kCount);
    for (std::size_t i = 0; i < kernels::kLanes; ++i) ASSERT_EQ(mine[i], theirs[i]) << changed << " " << i;
  }
}

TEST_P(LimitKernels, StoresAndCopiesReachEveryNumber) {
  for (const bool around : {false, true}) {
    std::fill_n(mine_.data(), kCount, -1.0F);
    k().limit_store(mine_.data(), 2.5F, kCount, around);
    ref().limit_store(theirs_.data(), 2.5F, kCount, around);
    expect_same();
  }
  k().limit_copy(mine_.data(), src_.data(), kCount);
  ref().limit_copy(theirs_.data(), src_.data(), kCount);
  expect_same();
}

TEST_P(LimitKernels, ChainsTakeEveryStep) {
  for (const std::size_t steps : {std::size_t{0}, std::size_t{1}, std::size_t{17}}) {
    k().limit_multiply_add(mine_.data(), src_.data(), 0.999F, 1e-3F, steps, kCount);
    ref().limit_multiply_add(theirs_.data(), src_.data(), 0.999F, 1e-3F, steps, kCount);
    expect_same();
    k().limit_fused(mine_.data(), src_.data(), 0.999F, 1e-3F, steps, kCount);
    ref().limit_fused(theirs_.data(), src_.data(), 0.999F, 1e-3F, steps, kCount);
    expect_same();
    k().limit_divide(mine_.data(), src_.data(), 1.7F, steps, kCount);
    ref().limit_divide(theirs_.data(), src_.data(), 1.7F, steps, kCount);
    expect_same();
  }
}

SPECTILE_FOR_EVERY_ISA(LimitKernels);

}  // namespace
}  // namespace spectile::test
