// Arrays of a caller's for the tests: elements at any place in guarded memory, and their values in long
// double.
#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <spectile/isa.hpp>
#include <spectile/lanes/element_type.hpp>
#include <vector>

#include "src/reference/half.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {

/// Lane counts below, at and above a block, and of many blocks.
inline constexpr std::size_t kArraySizes[] = {1, 63, 64, 65, 1000};

inline std::size_t bytes_of(ElementType type) {
  if (type == ElementType::kUint8) return 1;
  return type == ElementType::kFloat ? 4 : 2;
}

inline std::uint32_t last_code(ElementType type) {
  return type == ElementType::kUint8 ? 255 : 65535;
}

/// A float or the pattern of a half or a code, to a float.
inline float decoded(ElementType type, bool srgb, std::uint32_t bits) {
  if (type == ElementType::kFloat) return std::bit_cast<float>(bits);
  if (type == ElementType::kHalf) return reference::float_from_half(static_cast<std::uint16_t>(bits));
  const long double v = static_cast<long double>(bits) / last_code(type);
  if (!srgb) return static_cast<float>(v);
  return static_cast<float>(v <= 0.04045L ? v / 12.92L : std::pow((v + 0.055L) / 1.055L, 2.4L));
}

inline std::uint32_t encoded(ElementType type, bool srgb, float value) {
  if (type == ElementType::kFloat) return std::bit_cast<std::uint32_t>(value);
  if (type == ElementType::kHalf) return reference::half_from_float(value);
  if (!(value > 0)) return 0;
  if (value >= 1) return last_code(type);
  long double v = value;
  if (srgb) v = v <= 0.0031308L ? 12.92L * v : 1.055L * std::pow(v, 1 / 2.4L) - 0.055L;
  return static_cast<std::uint32_t>(std::nearbyint(v * last_code(type)));
}

/// The same float or half, any NaN like any other; the same code.
inline bool same_element(ElementType type, std::uint32_t a, std::uint32_t b) {
  if (type == ElementType::kFloat) return same_bits(std::bit_cast<float>(a), std::bit_cast<float>(b));
  if (type != ElementType::kHalf) return a == b;
  return same_bits(decoded(type, false, a), decoded(type, false, b));
}

/// Where the elements of an array lie. Units: bytes.
struct Places {
  std::ptrdiff_t lane = 0;
  std::ptrdiff_t sample = 0;
};

/// Memory with an array in it that starts `shift` bytes beyond a multiple of 64, or, where strides are
/// negative, ends as far before one; every other byte is a guard.
class CallerMemory {
 public:
  CallerMemory(ElementType type, std::size_t lanes, std::size_t samples, Places places, std::size_t shift)
      : type_(type), lanes_(lanes), samples_(samples), places_(places) {
    std::ptrdiff_t low = 0;
    std::ptrdiff_t high = 0;
    for (const auto& [stride, count] : {std::pair{places.lane, lanes}, std::pair{places.sample, samples}}) {
      const std::ptrdiff_t last = stride * (static_cast<std::ptrdiff_t>(count) - 1);
      (last < 0 ? low : high) += last;
    }
    before_ = (static_cast<std::size_t>(-low) + 191) / 64 * 64 + shift;
    floats_ = Floats((before_ + static_cast<std::size_t>(high) + 132) / sizeof(float));
    for (std::size_t i = 0; i < size(); ++i) bytes()[i] = guard(i);
  }

  void* data() { return bytes() + before_; }
  std::uint32_t get(std::size_t lane, std::size_t sample) const {
    std::uint32_t bits = 0;  // little endian
    std::memcpy(&bits, bytes() + offset(lane, sample), bytes_of(type_));
    return bits;
  }
  void set(std::size_t lane, std::size_t sample, std::uint32_t bits) {
    std::memcpy(bytes() + offset(lane, sample), &bits, bytes_of(type_));
  }
  /// Any bits at all, and special values of floats and halves.
  void fill(std::uint32_t seed) {
    const Floats values = arbitrary_floats(lanes_ * samples_, seed);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool integer = type_ == ElementType::kUint8 || type_ == ElementType::kUint16;
      const auto bits = std::bit_cast<std::uint32_t>(values[i]);
      set(i / samples_, i % samples_, integer ? bits ^ bits >> 16 : encoded(type_, false, values[i]));
    }
  }
  /// Every byte that belongs to no element is as it was.
  testing::AssertionResult guards_hold() const {
    std::vector<bool> owned(size());
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
      for (std::size_t k = 0; k < samples_; ++k)
        for (std::size_t b = 0; b < bytes_of(type_); ++b) owned[offset(lane, k) + b] = true;
    }
    for (std::size_t i = 0; i < size(); ++i) {
      if (!owned[i] && bytes()[i] != guard(i))
        return testing::AssertionFailure() << "byte " << static_cast<long>(i - before_) << " was written";
    }
    return testing::AssertionSuccess();
  }
  std::vector<unsigned char> copy() const { return {bytes(), bytes() + size()}; }

 private:
  static unsigned char guard(std::size_t i) { return static_cast<unsigned char>(i * 31 + 7); }
  std::size_t size() const { return floats_.size() * sizeof(float); }
  unsigned char* bytes() { return reinterpret_cast<unsigned char*>(floats_.data()); }
  const unsigned char* bytes() const { return reinterpret_cast<const unsigned char*>(floats_.data()); }
  std::size_t offset(std::size_t lane, std::size_t sample) const {
    return before_ + static_cast<std::size_t>(static_cast<std::ptrdiff_t>(lane) * places_.lane +
                                              static_cast<std::ptrdiff_t>(sample) * places_.sample);
  }

  ElementType type_;
  std::size_t lanes_;
  std::size_t samples_;
  Places places_;
  std::size_t before_ = 0;
  Floats floats_{0};
};

/// Zeroed memory that ends where the process's ends: an access behind it is a fault.
class MemoryAtPageEnd {
 public:
  explicit MemoryAtPageEnd(std::size_t bytes) : page_(static_cast<std::size_t>(::sysconf(_SC_PAGESIZE))) {
    size_ = (bytes + page_ - 1) / page_ * page_ + page_;
    pages_ = static_cast<std::byte*>(
        ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    EXPECT_EQ(::mprotect(pages_ + size_ - page_, page_, PROT_NONE), 0);
    data_ = pages_ + size_ - page_ - bytes;
  }
  MemoryAtPageEnd(const MemoryAtPageEnd&) = delete;
  MemoryAtPageEnd& operator=(const MemoryAtPageEnd&) = delete;
  ~MemoryAtPageEnd() { ::munmap(pages_, size_); }
  void* data() { return data_; }

 private:
  std::size_t page_;
  std::size_t size_ = 0;
  std::byte* pages_ = nullptr;
  std::byte* data_ = nullptr;
};

/// Calls work(execution) on every instruction set, on one thread and on several.
inline void on_every_setting(const std::function<void(const Execution&)>& work) {
  for (const std::string& isa : available_isas()) {
    SCOPED_TRACE(isa);
    ASSERT_TRUE(force_isa(isa));
    for (const Execution& execution : {Execution{1, 16384}, Execution{3, 64}}) {
      work(execution);
      if (testing::Test::HasFatalFailure()) break;
    }
  }
  ASSERT_TRUE(force_isa(""));
}

/// The padding of a plane of lanes is 0, bit by bit.
inline bool padding_is_zero(const float* plane, std::size_t lanes) {
  return std::all_of(plane + lanes, plane + blocks_for(lanes) * kLanesPerBlock,
                     [](float v) { return std::bit_cast<std::uint32_t>(v) == 0; });
}

}  // namespace spectile::test
