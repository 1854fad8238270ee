// The loops that find a machine's limits do what they say: the reference's bits on every instruction set.
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

class PeakKernels : public KernelTest {
 protected:
  static constexpr std::size_t kCount = 2 * kernels::kPeakChains;
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

TEST_P(PeakKernels, LoadsSeeEveryNumber) {
  std::uint32_t mine[kernels::kLanes];
  std::uint32_t theirs[kernels::kLanes];
  for (const std::size_t changed : {std::size_t{0}, std::size_t{63}, kCount - 1}) {
    src_.data()[changed] += 1;
    k().peak_load(mine, src_.data(), kCount);
    ref().peak_load(theirs, src_.data(), kCount);
    for (std::size_t i = 0; i < kernels::kLanes; ++i) ASSERT_EQ(mine[i], theirs[i]) << changed << " " << i;
  }
}

TEST_P(PeakKernels, StoresAndCopiesFillEveryNumber) {
  for (const bool non_temporal : {false, true}) {
    std::fill_n(mine_.data(), kCount, -1.0F);
    k().peak_store(mine_.data(), 2.5F, kCount, non_temporal);
    ref().peak_store(theirs_.data(), 2.5F, kCount, non_temporal);
    expect_same();
  }
  k().peak_copy(mine_.data(), src_.data(), kCount);
  ref().peak_copy(theirs_.data(), src_.data(), kCount);
  expect_same();
}

TEST_P(PeakKernels, ChainsTakeEveryStep) {
  for (const std::size_t steps : {std::size_t{0}, std::size_t{1}, std::size_t{17}}) {
    k().peak_multiply_add(mine_.data(), src_.data(), 0.999F, 1e-3F, steps, kCount);
    ref().peak_multiply_add(theirs_.data(), src_.data(), 0.999F, 1e-3F, steps, kCount);
    expect_same();
    k().peak_fused(mine_.data(), src_.data(), 0.999F, 1e-3F, steps, kCount);
    ref().peak_fused(theirs_.data(), src_.data(), 0.999F, 1e-3F, steps, kCount);
    expect_same();
    k().peak_divide(mine_.data(), src_.data(), 1.7F, steps, kCount);
    ref().peak_divide(theirs_.data(), src_.data(), 1.7F, steps, kCount);
    expect_same();
  }
}

SPECTILE_FOR_EVERY_ISA(PeakKernels);

}  // namespace
}  // namespace spectile::test
