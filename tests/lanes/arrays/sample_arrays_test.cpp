// Spectra [n][K] and [K][n], of floats and halves, from and to batches.
#include <spectile/lanes/sample_arrays.hpp>
#include <spectile/lanes/wavelengths.hpp>

#include "tests/lanes/arrays/caller_memory.hpp"

namespace spectile::test {
namespace {

struct SampleLayout {
  const char* name;
  Places (*strides)(std::ptrdiff_t samples, std::ptrdiff_t lanes);  ///< elements
  std::size_t shift;                                                ///< bytes
};
constexpr SampleLayout kSampleLayouts[] = {{"[n][K]",
                                            [](auto k, auto) {
                                              return Places{k, 1};
                                            },
                                            0},
                                           {"[n][K], odd address",
                                            [](auto k, auto) {
                                              return Places{k, 1};
                                            },
                                            1},
                                           {"[n][K + 3]",
                                            [](auto k, auto) {
                                              return Places{k + 3, 1};
                                            },
                                            4},
                                           {"[n][2 K], every second",
                                            [](auto k, auto) {
                                              return Places{2 * k, 2};
                                            },
                                            0},
                                           {"[n][K] from the last",
                                            [](auto k, auto) {
                                              return Places{-k, 1};
                                            },
                                            0},
                                           {"[K][n]",
                                            [](auto, auto n) {
                                              return Places{1, n};
                                            },
                                            0},
                                           {"[K][n + 5], odd address",
                                            [](auto, auto n) {
                                              return Places{1, n + 5};
                                            },
                                            3}};

SpectralAxis axis_of(std::size_t samples) {
  if (samples <= SpectralAxis::kMaxWavelengths) return *SpectralAxis::own_wavelengths(samples);
  return *Bands::uniform(400, 400 + 2.0 * static_cast<double>(samples), 2);
}

struct SampleCase {
  SampleCase(ElementType type, const SampleLayout& layout, std::size_t samples, std::size_t lanes)
      : name(std::string(type == ElementType::kHalf ? "half " : "float ") + layout.name + ", " +
             std::to_string(samples) + " samples, " + std::to_string(lanes) + " lanes"),
        strides(layout.strides(static_cast<std::ptrdiff_t>(samples), static_cast<std::ptrdiff_t>(lanes))),
        memory(type, lanes, samples,
               {strides.lane * static_cast<std::ptrdiff_t>(bytes_of(type)),
                strides.sample * static_cast<std::ptrdiff_t>(bytes_of(type))},
               layout.shift),
        view{memory.data(), type, lanes, samples, strides.lane, strides.sample} {}
  std::string name;
  Places strides;
  CallerMemory memory;
  MutableSampleArray view;
};

void for_every_sample_case(const std::function<void(SampleCase&)>& work) {
  for (const ElementType type : {ElementType::kFloat, ElementType::kHalf}) {
    for (const SampleLayout& layout : kSampleLayouts) {
      for (const std::size_t samples : {1, 3, 4, 17, 60, 70, 131}) {
        for (const std::size_t lanes : kArraySizes) {
          SampleCase one(type, layout, samples, samples > 60 ? std::min<std::size_t>(lanes, 130) : lanes);
          SCOPED_TRACE(one.name);
          work(one);
          if (testing::Test::HasFatalFailure()) return;
        }
      }
    }
  }
}

TEST(SampleArrays, AreReadFromEveryLayout) {
  for_every_sample_case([](SampleCase& one) {
    one.memory.fill(3);
    const auto before = one.memory.copy();
    const std::size_t lanes = one.view.lanes;
    const SpectralAxis axis = axis_of(one.view.samples);
    on_every_setting([&](const Execution& execution) {
      auto spectra = *SampledSpectra::constant(axis, lanes, 9);
      ASSERT_TRUE(read_samples(one.view, spectra, execution));
      for (std::size_t i = 0; i < spectra.blocks() * kLanesPerBlock; ++i) {
        for (std::size_t k = 0; k < axis.count(); ++k) {
          const float want = i < lanes ? decoded(one.view.type, false, one.memory.get(i, k)) : 0.0F;
          ASSERT_TRUE(same_bits(spectra.at(i, k), want)) << "lane " << i << " sample " << k;
        }
      }
    });
    ASSERT_EQ(one.memory.copy(), before);
  });
}

TEST(SampleArrays, AreWrittenToEveryLayoutAndNowhereElse) {
  for_every_sample_case([](SampleCase& one) {
    const std::size_t lanes = one.view.lanes;
    const SpectralAxis axis = axis_of(one.view.samples);
    const Floats values = arbitrary_floats(lanes * axis.count(), 5);
    const auto spectra = batch_of(
        axis, lanes, [&](std::size_t lane, std::size_t k) { return values[lane * axis.count() + k]; });
    on_every_setting([&](const Execution& execution) {
      one.memory.fill(1);
      ASSERT_TRUE(write_samples(spectra, one.view, execution));
      for (std::size_t i = 0; i < lanes; ++i) {
        for (std::size_t k = 0; k < axis.count(); ++k)
          ASSERT_TRUE(same_element(one.view.type, one.memory.get(i, k),
                                   encoded(one.view.type, false, spectra.at(i, k))))
              << "lane " << i << " sample " << k << " of " << spectra.at(i, k);
      }
      ASSERT_TRUE(one.memory.guards_hold());
    });
  });
}

TEST(SampleArrays, NothingBehindTheLastIsTouched) {
  for (const ElementType type : {ElementType::kFloat, ElementType::kHalf}) {
    for (const std::size_t samples : {1, 3, 4, 17, 60, 70}) {
      for (const std::size_t lanes : {1, 16, 64, 65, 128}) {
        const SpectralAxis axis = axis_of(samples);
        MemoryAtPageEnd memory(lanes * samples * bytes_of(type));
        const auto k = static_cast<std::ptrdiff_t>(samples);
        const auto n = static_cast<std::ptrdiff_t>(lanes);
        const MutableSampleArray rows{memory.data(), type, lanes, samples, k, 1};
        const MutableSampleArray planes{memory.data(), type, lanes, samples, 1, n};
        on_every_setting([&](const Execution& execution) {
          auto spectra = *SampledSpectra::create(axis, lanes);
          for (const MutableSampleArray& array : {rows, planes}) {
            ASSERT_TRUE(read_samples(array, spectra, execution));
            ASSERT_TRUE(write_samples(spectra, array, execution));
          }
        });
      }
    }
  }
}

TEST(SampleArrays, PackedOnesReturnBitByBit) {
  std::vector<float> rows(130 * 60);
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = std::bit_cast<float>(static_cast<std::uint32_t>(i * 2654435761U));
  auto spectra = *SampledSpectra::create(Bands(), 130);
  ASSERT_TRUE(read_samples(*SampleArray::lane_rows(rows, 60), spectra));
  std::vector<float> planes(rows.size());
  ASSERT_TRUE(write_samples(spectra, *MutableSampleArray::sample_rows(planes, 60)));
  for (std::size_t i = 0; i < 130; ++i) {
    for (std::size_t k = 0; k < 60; ++k)
      ASSERT_EQ(std::memcmp(&planes[k * 130 + i], &rows[i * 60 + k], sizeof(float)), 0);
  }
  std::vector<std::uint16_t> halves(rows.size());
  std::vector<std::uint16_t> half_planes(rows.size());
  ASSERT_TRUE(write_samples(spectra, *MutableSampleArray::lane_rows_of_halves(halves, 60)));
  ASSERT_TRUE(write_samples(spectra, *MutableSampleArray::sample_rows_of_halves(half_planes, 60)));
  for (std::size_t i = 0; i < 130; ++i) {
    for (std::size_t k = 0; k < 60; ++k) ASSERT_EQ(half_planes[k * 130 + i], halves[i * 60 + k]);
  }
}

TEST(SampleArrays, HoldWavelengthsAndDensities) {
  const std::vector<float> nm = {400, 500, 600, 700, 450, 550, 650, 750};
  auto w = *SampledWavelengths::create(2, 4);
  ASSERT_TRUE(read_samples(*SampleArray::lane_rows(nm, 4), w.lambda_nm));
  EXPECT_EQ(w.lambda_nm.at(1, 2), 650);
}

}  // namespace
}  // namespace spectile::test
