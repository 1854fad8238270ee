// Shared by the tests: aligned test data with special values in it, and comparison by bits.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <spectile/isa.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <string>
#include <vector>

namespace spectile::test {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kTiny = std::numeric_limits<float>::denorm_min();
inline constexpr float kSmallestNormal = std::numeric_limits<float>::min();
inline constexpr float kMost = std::numeric_limits<float>::max();

/// Lane counts around the vector widths and the block, and one of many blocks.
inline constexpr std::size_t kSizes[] = {1, 15, 16, 17, 63, 64, 65, 4099};

/// Values at which float, half and colour arithmetic change their ways.
inline const std::vector<float>& special_values() {
  static const std::vector<float> values = {0.0F,
                                            -0.0F,
                                            kTiny,
                                            -kTiny,
                                            3 * kTiny,
                                            kSmallestNormal,
                                            -kSmallestNormal,
                                            kMost,
                                            -kMost,
                                            kInf,
                                            -kInf,
                                            kNan,
                                            1.0F,
                                            1.0F + 0x1p-23F,
                                            -1.0F,
                                            1.0F - 0x1p-24F,
                                            0.5F,
                                            0.25F,
                                            2.0F,
                                            65504.0F,
                                            65519.99F,
                                            65520.0F,
                                            -65504.0F,
                                            1e-8F,
                                            0x1p-24F,
                                            0x1p-25F,
                                            0x1p-14F,
                                            1e30F,
                                            -1e30F,
                                            88.72284F,
                                            -103.98F,
                                            0.0031308F,
                                            16777216.0F,
                                            -3.0F,
                                            1e-38F};
  return values;
}

inline bool same_bits(float a, float b) {
  return (std::isnan(a) && std::isnan(b)) ||
         std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

/// Zeroed floats at a multiple of 64 bytes, with a guard behind them that no kernel may touch.
class Floats {
 public:
  explicit Floats(std::size_t count) : buffer_(*FloatBuffer::create(count + kGuard)), count_(count) {
    std::fill_n(buffer_.data(), count, 0.0F);
    std::fill_n(buffer_.data() + count, kGuard, kSentinel);
  }
  explicit Floats(std::span<const float> values) : Floats(values.size()) {
    std::copy(values.begin(), values.end(), data());
  }
  float* data() { return buffer_.data(); }
  const float* data() const { return buffer_.data(); }
  std::size_t size() const { return count_; }
  float& operator[](std::size_t i) { return buffer_.data()[i]; }
  float operator[](std::size_t i) const { return buffer_.data()[i]; }
  bool guard_holds() const {
    return std::all_of(data() + count_, data() + count_ + kGuard, [](float v) { return v == kSentinel; });
  }

 private:
  static constexpr std::size_t kGuard = 64;
  static constexpr float kSentinel = -12345.75F;
  FloatBuffer buffer_;
  std::size_t count_;
};

/// A third each of special values, of any bits at all, and of ordinary samples from 0 to 1.
inline Floats arbitrary_floats(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  const auto& special = special_values();
  Floats out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t kind = random() % 3;
    if (kind == 0) out[i] = special[random() % special.size()];
    if (kind == 1) out[i] = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (kind == 2) out[i] = unit(random);
  }
  return out;
}

/// Samples from `low` to `high`.
inline Floats plain_floats(std::size_t count, std::uint32_t seed, float low = 0.0F, float high = 1.0F) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(low, high);
  Floats out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = unit(random);
  return out;
}

/// Every element equal in its bits, any NaN like any other; names the first that is not.
inline testing::AssertionResult same_bits(const float* got, const float* want, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (same_bits(got[i], want[i])) continue;
    return testing::AssertionFailure()
           << "element " << i << " of " << count << " is " << got[i] << ", not " << want[i];
  }
  return testing::AssertionSuccess();
}

inline testing::AssertionResult same_bits(const Floats& got, const Floats& want) {
  if (!got.guard_holds()) return testing::AssertionFailure() << "wrote behind the end";
  if (got.size() != want.size()) return testing::AssertionFailure() << "sizes differ";
  return same_bits(got.data(), want.data(), got.size());
}

/// The lanes of two batches, padding left out.
inline testing::AssertionResult same_lanes(const SampledSpectra& got, const SampledSpectra& want) {
  for (std::size_t lane = 0; lane < want.lanes(); ++lane) {
    for (std::size_t band = 0; band < want.axis().count(); ++band) {
      if (same_bits(got.at(lane, band), want.at(lane, band))) continue;
      return testing::AssertionFailure() << "lane " << lane << " band " << band << " is "
                                         << got.at(lane, band) << ", not " << want.at(lane, band);
    }
  }
  return testing::AssertionSuccess();
}

/// A batch at wavelengths of each lane's own, 0 at first.
inline SampledSpectra own_batch(std::size_t lanes, std::size_t wavelengths) {
  return *SampledSpectra::create(*SpectralAxis::own_wavelengths(wavelengths), lanes);
}

/// A batch with samples from `fill(lane, sample)`.
template <class Fill>
SampledSpectra batch_of(const SpectralAxis& axis, std::size_t lanes, Fill fill) {
  auto batch = *SampledSpectra::create(axis, lanes);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    for (std::size_t k = 0; k < axis.count(); ++k) batch.at(lane, k) = fill(lane, k);
  }
  return batch;
}

/// A batch of plain or of wild samples.
inline SampledSpectra batch_from(const Bands& bands, std::size_t lanes, const Floats& values) {
  return batch_of(bands, lanes, [&](std::size_t lane, std::size_t band) {
    return values[(lane * bands.count() + band) % values.size()];
  });
}

/// A parameter's name in letters, digits and underscores.
inline std::string test_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.' || c == '-'; }, '_');
  return name;
}

/// Error code of a result that should have failed, shown as a number; -1 for success.
template <class T>
int code_of(const Result<T>& result) {
  return result ? -1 : static_cast<int>(result.error().code);
}
inline int code(ErrorCode c) {
  return static_cast<int>(c);
}

}  // namespace spectile::test
