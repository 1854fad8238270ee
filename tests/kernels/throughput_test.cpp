// The kernel of a bounce and Russian roulette: every instruction set gives the reference's bits.
#include "tests/kernels/kernel_fixture.hpp"

namespace spectile::test {
namespace {

using kernels::kLanes;

class ThroughputKernels : public KernelTest {};

TEST_P(ThroughputKernels, BouncesAreTheReferences) {
  for (const std::size_t samples : {1, 4, 7, 60}) {
    for (const bool arbitrary : {false, true}) {
      const std::size_t blocks = 5;
      const std::size_t n = blocks * samples * kLanes;
      const auto values = [&](std::size_t count, std::uint32_t seed) {
        Floats out = plain_floats(count, seed, 0, 2);
        const Floats strange = arbitrary_floats(count, seed + 1);
        for (std::size_t i = 0; arbitrary && i < count; i += 7) out[i] = strange[i];
        for (std::size_t i = 3; i < count; i += 29) out[i] = 0;
        return out;
      };
      const Floats a = values(n, 1);
      const Floats f = values(n, 3);
      const Floats density = values(blocks * kLanes, 5);
      Floats u = values(blocks * kLanes, 7);
      for (std::size_t i = 0; i < u.size(); i += 3) u[i] = 0.5F * u[i];
      for (const bool roulette : {false, true}) {
        for (const bool in_place : {false, true}) {
          const auto run = [&](const kernels::KernelTable& t, Floats& out) {
            std::copy_n(a.data(), n, out.data());
            std::vector<std::uint64_t> ended(blocks, 0x55);
            t.update_throughput(out.data(), ended.data(), in_place ? out.data() : a.data(), f.data(),
                                density.data(), roulette ? u.data() : nullptr, samples, blocks);
            return ended;
          };
          Floats got(n);
          Floats want(n);
          EXPECT_EQ(run(k(), got), run(ref(), want));
          EXPECT_TRUE(same_bits(got, want)) << samples;
          EXPECT_TRUE(got.guard_holds());
        }
      }
    }
  }
}

SPECTILE_FOR_EVERY_ISA(ThroughputKernels);

}  // namespace
}  // namespace spectile::test
