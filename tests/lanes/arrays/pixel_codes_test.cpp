// Integers as pixels: every code, the boundaries between codes, and numbers beyond them.
#include <numeric>
#include <spectile/lanes/pixels.hpp>

#include "tests/lanes/arrays/caller_memory.hpp"

namespace spectile::test {
namespace {

/// Values of grey pixels.
template <class Code>
std::vector<float> read_codes(const std::vector<Code>& codes, PixelEncoding encoding) {
  auto lanes = *ScalarLanes::create(codes.size());
  float* const plane = lanes.span().data;
  EXPECT_TRUE(
      read_pixels(*PixelArray::interleaved(codes, 1, encoding), {{plane, plane, plane}, codes.size()}));
  return {plane, plane + codes.size()};
}

template <class Code>
std::vector<Code> write_codes(const std::vector<float>& values, PixelEncoding encoding) {
  auto lanes = *ScalarLanes::create(values.size());
  std::copy(values.begin(), values.end(), lanes.span().data);
  const float* const plane = lanes.view().data;
  std::vector<Code> codes(values.size());
  EXPECT_TRUE(write_pixels({{plane, plane, plane}, values.size()}, {},
                           *MutablePixelArray::interleaved(codes, 1, encoding)));
  return codes;
}

template <class Code>
class PixelCodes : public testing::Test {
 protected:
  static constexpr std::size_t kLast = std::numeric_limits<Code>::max();
  static constexpr ElementType kType = sizeof(Code) == 1 ? ElementType::kUint8 : ElementType::kUint16;
  static std::vector<Code> all() {
    std::vector<Code> codes(kLast + 1);
    std::iota(codes.begin(), codes.end(), Code{0});
    return codes;
  }
};
using CodeTypes = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(PixelCodes, CodeTypes);

TYPED_TEST(PixelCodes, AreTheNearestFloatsToTheirExactValues) {
  const auto codes = TestFixture::all();
  for (const PixelEncoding encoding : {PixelEncoding::kLinear, PixelEncoding::kSrgb}) {
    const auto values = read_codes(codes, encoding);
    for (const TypeParam code : codes)
      ASSERT_EQ(values[code], decoded(TestFixture::kType, encoding == PixelEncoding::kSrgb, code)) << code;
    EXPECT_EQ(values.front(), 0);
    EXPECT_EQ(values.back(), 1);
  }
}

TYPED_TEST(PixelCodes, AllReturn) {
  const auto codes = TestFixture::all();
  for (const PixelEncoding encoding : {PixelEncoding::kLinear, PixelEncoding::kSrgb})
    EXPECT_EQ(write_codes<TypeParam>(read_codes(codes, encoding), encoding), codes);
}

TYPED_TEST(PixelCodes, ChangeAtTheFirstFloatBeyondTheMiddle) {
  for (const bool srgb : {false, true}) {
    std::vector<float> values;
    std::vector<TypeParam> want;
    for (std::size_t code = 0; code < TestFixture::kLast; ++code) {
      const long double v = (static_cast<long double>(code) + 0.5L) / TestFixture::kLast;
      const long double middle =
          srgb && v > 0.04045L ? std::pow((v + 0.055L) / 1.055L, 2.4L) : (srgb ? v / 12.92L : v);
      auto at = static_cast<float>(middle);
      if (at < middle) at = std::nextafter(at, 2.0F);
      if (at == middle) continue;  // a tie
      for (const float value : {std::nextafter(at, 0.0F), at}) values.push_back(value);
      want.push_back(static_cast<TypeParam>(code));
      want.push_back(static_cast<TypeParam>(code + 1));
    }
    EXPECT_EQ(write_codes<TypeParam>(values, srgb ? PixelEncoding::kSrgb : PixelEncoding::kLinear), want);
  }
}

TYPED_TEST(PixelCodes, AreTheNearestOfRandomValues) {
  const Floats random = plain_floats(20000, 3);
  const std::vector<float> values(random.data(), random.data() + random.size());
  for (const bool srgb : {false, true}) {
    const auto codes = write_codes<TypeParam>(values, srgb ? PixelEncoding::kSrgb : PixelEncoding::kLinear);
    for (std::size_t i = 0; i < codes.size(); ++i)
      ASSERT_EQ(codes[i], encoded(TestFixture::kType, srgb, values[i])) << values[i];
  }
}

TYPED_TEST(PixelCodes, OfATieAreEven) {
  // 127.5 and 32767.5: 0.5 is the only float in the middle of two codes.
  EXPECT_EQ(write_codes<TypeParam>({0.5F}, PixelEncoding::kLinear)[0], TestFixture::kLast / 2 + 1);
}

TYPED_TEST(PixelCodes, LimitWhatIsBeyondThem) {
  const std::vector<float> values = {kNan,  -kNan,  -kInf,     -1, -0.0F, -kTiny,
                                     kTiny, 1e-38F, 1 + 1e-6F, 2,  kMost, kInf};
  const auto last = static_cast<TypeParam>(TestFixture::kLast);
  const std::vector<TypeParam> want = {0, 0, 0, 0, 0, 0, 0, 0, last, last, last, last};
  for (const PixelEncoding encoding : {PixelEncoding::kLinear, PixelEncoding::kSrgb})
    EXPECT_EQ(write_codes<TypeParam>(values, encoding), want);
}

TEST(SrgbPixelCodes, AreThePublishedOnes) {
  // 8 bit middle grey of 18 %, and the codes of the kink at 0.0031308.
  EXPECT_EQ(write_codes<std::uint8_t>({0.18F, 0.5F, 0.003F, 0.0031308F, 0.0033F}, PixelEncoding::kSrgb),
            (std::vector<std::uint8_t>{118, 188, 10, 10, 11}));
  EXPECT_NEAR(read_codes<std::uint8_t>({128}, PixelEncoding::kSrgb)[0], 0.2158605F, 1e-7F);
}

TEST(HalfPixels, AreAllPatternsAndReturn) {
  std::vector<std::uint16_t> patterns(65536);
  std::iota(patterns.begin(), patterns.end(), std::uint16_t{0});
  auto rgb = *ColorLanes::create(16384);
  auto alpha = *ScalarLanes::create(16384);
  std::vector<std::uint16_t> back(65536);
  ASSERT_TRUE(read_pixels(*PixelArray::interleaved_halves(patterns, 4), rgb, alpha));
  ASSERT_TRUE(write_pixels(rgb, alpha, *MutablePixelArray::interleaved_halves(back, 4)));
  for (std::size_t i = 0; i < 65536; ++i) {
    const bool nan = (patterns[i] & 0x7C00) == 0x7C00 && (patterns[i] & 0x3FF) != 0;
    ASSERT_EQ(back[i], nan ? patterns[i] | 0x200 : patterns[i]);
  }
}

TEST(HalfPixels, RoundTiesToEvenAndBecomeInfinite) {
  auto rgb = *ColorLanes::create(2);
  const float values[] = {65519.99F, 65520, -1e30F, 1 + 0x1p-11F, 1 + 3 * 0x1p-11F, 0x1p-25F};
  for (std::size_t i = 0; i < 6; ++i) rgb.at(i / 3, i % 3) = values[i];
  std::vector<std::uint16_t> out(6);
  ASSERT_TRUE(write_pixels(rgb, {}, *MutablePixelArray::interleaved_halves(out, 3)));
  EXPECT_EQ(out, (std::vector<std::uint16_t>{0x7BFF, 0x7C00, 0xFC00, 0x3C00, 0x3C02, 0}));
}

}  // namespace
}  // namespace spectile::test
