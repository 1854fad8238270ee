// The numbers' stress test finds every operation within its bound, on every instruction set, and finds a
// fault that is put into one.
#include "bench/stress/stress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bench/operations/lane_memory.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/reference/table.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using kernels::KernelTable;
using measure::StressSettings;

StressSettings settings_for(const KernelTable& table) {
  StressSettings s;
  s.table = &table;
  s.samples = std::size_t{1} << 13;
  s.few_bands = true;
  return s;
}

class Stress : public testing::TestWithParam<const char*> {};

TEST_P(Stress, OperationsStayWithinTheirBounds) {
  const auto table = dispatch::find(GetParam());
  if (!table) GTEST_SKIP() << GetParam() << " does not run on this machine";
  const auto found = measure::stress_operations(settings_for(**table));
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_GT(found->size(), 30U);
  for (const StressResult& r : *found) {
    EXPECT_EQ(r.beyond, 0U) << r.operation << ": " << r.worst << " of " << r.bound << " at " << r.worst_case;
    EXPECT_GT(r.cases, 500U) << r.operation;
    EXPECT_LE(r.worst, r.bound) << r.operation;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryTable, Stress, testing::Values("scalar", "sse4.2", "avx2", "avx512", "neon"),
                         [](const auto& one) { return test_name(one.param); });

TEST(StressOfNumbers, TheRestStaysWithinItsBounds) {
  const auto found = measure::stress_others(settings_for(reference::kKernelTable));
  ASSERT_TRUE(found) << found.error().message;
  std::set<std::string> names;
  for (const StressResult& r : *found) {
    names.insert(r.operation);
    EXPECT_EQ(r.beyond, 0U) << r.operation << ": " << r.worst << " of " << r.bound << " at " << r.worst_case;
    EXPECT_GT(r.cases, 0U) << r.operation;
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"film: add up", "film: cancellation", "inverse of a matrix"}));
}

// Kernels with faults as small as they may be and still be faults.

void add_off_by_two_steps(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const float sum = a[i] + b[i];
    dst[i] = std::isfinite(sum) ? sum * (1.0F + 0x1p-22F) : sum;
  }
}

void exp_without_denormals(float* dst, const float* a, std::size_t n) noexcept {
  reference::kKernelTable.exp(dst, a, n);
  for (std::size_t i = 0; i < n; ++i) dst[i] = dst[i] < 0x1p-126F ? 0.0F : dst[i];
}

void clamp_that_loses_nan(float* dst, const float* a, float lo, float hi, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = a[i] > lo ? (a[i] < hi ? a[i] : hi) : lo;
}

void minimum_that_keeps_nan(float* dst, const float* spectra, std::size_t bands,
                            std::size_t blocks) noexcept {
  reference::kKernelTable.minimum(dst, spectra, bands, blocks);
  for (std::size_t i = 0; i < blocks * kernels::kLanes; ++i) {
    for (std::size_t b = 0; b < bands; ++b) {
      const float s = spectra[(i / kernels::kLanes * bands + b) * kernels::kLanes + i % kernels::kLanes];
      if (s != s) dst[i] = s;
    }
  }
}

void project_without_its_last_band(float* const dst[3], const float* spectra, const float* weights,
                                   std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * kernels::kLanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      dst[k][i] = 0;
      for (std::size_t b = 0; b + 1 < bands; ++b) {
        dst[k][i] += weights[4 * b + k] *
                     spectra[(i / kernels::kLanes * bands + b) * kernels::kLanes + i % kernels::kLanes];
      }
    }
  }
}

void half_rounded_down(std::uint16_t* dst, const float* src, std::size_t n) noexcept {
  reference::kKernelTable.float_to_half(dst, src, n);
  for (std::size_t i = 0; i < n; ++i) {
    float back = 0;
    reference::kKernelTable.half_to_float(&back, dst + i, 1);
    if (std::isfinite(back) && back > 0 && back > src[i]) --dst[i];
  }
}

void film_add_without_rests(const kernels::FilmSums& to, const kernels::FilmGrid& grid,
                            const kernels::FilmEntries& entries, const float* quads,
                            std::size_t count) noexcept {
  reference::kKernelTable.film_add(to, grid, entries, quads, count);
  for (std::size_t i = 0; i < entries.count; ++i) {
    std::int64_t* const pixel =
        to.tiles[entries.tile] + to.offset + static_cast<std::size_t>(entries.address[i]) * to.limbs;
    std::fill_n(pixel + kernels::kFilmQuadRest, 4, 0);
  }
}

void film_place_one_to_the_right(const kernels::FilmPlaces& out, const kernels::FilmWindow& window,
                                 const kernels::FilmPositions& samples) noexcept {
  reference::kKernelTable.film_place(out, window, samples);
  for (std::size_t i = 0; i < samples.n; ++i) {
    if (out.address[i] >= 0 && samples.x[i] == 1.0F) ++out.address[i];
  }
}

void scan_rgb_that_takes_minus_zero_for_negative(kernels::RgbScan* scan, const float* const rgb[3],
                                                 std::size_t n) noexcept {
  reference::kKernelTable.scan_rgb(scan, rgb, n);
  for (std::size_t i = 0; i < n; ++i) scan->negative += rgb[0][i] == 0 && std::signbit(rgb[0][i]) ? 1 : 0;
}

void sigmoid_project_off_by_a_millionth(float* const dst[3], const kernels::SigmoidSpectra& spectra,
                                        const float* weights, std::size_t n) noexcept {
  reference::kKernelTable.sigmoid_project(dst, spectra, weights, n);
  for (std::size_t i = 0; i < n; ++i) dst[1][i] *= 1.000004F;
}

struct Fault {
  const char* operation;
  void (*put)(KernelTable&);
};

TEST(StressOfNumbers, FaultsAreFound) {
  const Fault faults[] = {
      {"add", [](KernelTable& t) { t.add = add_off_by_two_steps; }},
      {"exp", [](KernelTable& t) { t.exp = exp_without_denormals; }},
      {"clamp", [](KernelTable& t) { t.clamp = clamp_that_loses_nan; }},
      {"minimum", [](KernelTable& t) { t.minimum = minimum_that_keeps_nan; }},
      {"project to XYZ", [](KernelTable& t) { t.project = project_without_its_last_band; }},
      {"project re-radiation to XYZ", [](KernelTable&) {}},  // by the same kernel
      {"float to half", [](KernelTable& t) { t.float_to_half = half_rounded_down; }},
      {"film: add colours", [](KernelTable& t) { t.film_add = film_add_without_rests; }},
      {"film: add colours with filter weights", [](KernelTable&) {}},  // by the same kernel
      {"film: place samples", [](KernelTable& t) { t.film_place = film_place_one_to_the_right; }},
      {"count what is outside",
       [](KernelTable& t) { t.scan_rgb = scan_rgb_that_takes_minus_zero_for_negative; }},
      {"sigmoid: sum to a colour",
       [](KernelTable& t) { t.sigmoid_project = sigmoid_project_off_by_a_millionth; }},
      {"sigmoid-observer: sum to a colour", [](KernelTable&) {}},  // by the same kernel
  };
  KernelTable bad = reference::kKernelTable;
  for (const Fault& fault : faults) fault.put(bad);
  const auto found = measure::stress_operations(settings_for(bad));
  ASSERT_TRUE(found) << found.error().message;
  for (const Fault& fault : faults) {
    const auto r = std::find_if(found->begin(), found->end(),
                                [&](const StressResult& s) { return s.operation == fault.operation; });
    ASSERT_NE(r, found->end()) << fault.operation;
    EXPECT_GT(r->beyond, 0U) << fault.operation << " passed with its fault: worst " << r->worst;
    EXPECT_FALSE(r->worst_case.empty());
  }
  // And only those.
  for (const StressResult& r : *found) {
    const bool faulty = std::any_of(std::begin(faults), std::end(faults),
                                    [&](const Fault& f) { return r.operation == f.operation; });
    if (!faulty) {
      EXPECT_EQ(r.beyond, 0U) << r.operation;
    }
  }
}

}  // namespace
}  // namespace spectile::test
