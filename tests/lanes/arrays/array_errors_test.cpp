// Arrays that make no sense or do not match are refused, with the values, and nothing is written.
#include <gmock/gmock.h>

#include <spectile/lanes/pixels.hpp>
#include <spectile/lanes/sample_arrays.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using testing::HasSubstr;

struct Refused {
  ErrorCode code;
  const char* sentence;
};

template <class T>
void expect_refused(const Result<T>& result, const Refused& want) {
  ASSERT_FALSE(result) << want.sentence;
  EXPECT_EQ(code_of(result), code(want.code)) << result.error().message;
  EXPECT_THAT(result.error().message, HasSubstr(want.sentence));
}

TEST(ArrayErrors, OfPixels) {
  std::vector<float> memory(256, 5.0F);
  auto rgb = *ColorLanes::create(10);
  auto alpha = *ScalarLanes::create(10);
  const MutablePixelArray good{memory.data(), 10, ElementType::kFloat, 4, 16, 4, PixelEncoding::kLinear};
  const auto expect = [&](MutablePixelArray array, const Refused& want) {
    expect_refused(read_pixels(array, rgb, alpha), want);
    expect_refused(write_pixels(rgb, alpha, array), want);
  };
  MutablePixelArray bad = good;
  bad.channels = 2;
  expect(bad, {ErrorCode::kBadArgument, "1, 3 or 4 channels, not 2"});
  bad.channels = 0;
  expect(bad, {ErrorCode::kBadArgument, "not 0"});
  bad = good;
  bad.pixels = 11;
  expect(bad, {ErrorCode::kSizeMismatch, "the array has 11 pixels, the colours 10 lanes"});
  bad = good;
  bad.encoding = PixelEncoding::kSrgb;
  expect(bad, {ErrorCode::kBadArgument, "only integers are encoded as sRGB"});
  bad = good;
  bad.data = nullptr;
  expect(bad, {ErrorCode::kBadArgument, "the array of 10 pixels has no data"});
  bad = good;
  bad.pixel_stride_bytes = -2;
  expect(bad, {ErrorCode::kBadArgument, "a pixel stride of -2 bytes is less than an element, 4 bytes"});
  bad = good;
  bad.channel_stride_bytes = 0;
  expect(bad, {ErrorCode::kBadArgument, "a channel stride of 0 bytes"});
  bad = good;
  bad.pixel_stride_bytes = 15;
  expect(bad, {ErrorCode::kBadArgument,
               "10 pixels at a stride of 15 bytes, of 4 channels at a stride of 4 bytes, overlap"});
  bad = good;
  bad.pixel_stride_bytes = 4;
  bad.channel_stride_bytes = -39;
  expect(bad, {ErrorCode::kBadArgument, "overlap"});
  bad = good;
  bad.pixel_stride_bytes = std::numeric_limits<std::ptrdiff_t>::min();
  expect(bad, {ErrorCode::kBadArgument, "exceed the memory"});
  bad = good;
  bad.channel_stride_bytes = std::numeric_limits<std::ptrdiff_t>::max();
  expect(bad, {ErrorCode::kBadArgument, "exceed the memory"});
  EXPECT_TRUE(std::all_of(memory.begin(), memory.end(), [](float v) { return v == 5.0F; }));
  EXPECT_TRUE(write_pixels(rgb, alpha, good));
}

TEST(ArrayErrors, OfPixelsAndLanes) {
  std::vector<float> memory(256, 5.0F);
  auto rgb = *ColorLanes::create(10);
  auto alpha = *ScalarLanes::create(11);
  const auto four = *MutablePixelArray::interleaved(std::span(memory).first(40), 4);
  const auto three = *MutablePixelArray::interleaved(std::span(memory).first(30), 3);
  const auto grey = *MutablePixelArray::interleaved(std::span(memory).first(10), 1);
  expect_refused(read_pixels(four, rgb, alpha), {ErrorCode::kSizeMismatch, "10 pixels, alpha 11 lanes"});
  expect_refused(write_pixels(rgb, alpha, four), {ErrorCode::kSizeMismatch, "10 pixels, alpha 11 lanes"});
  expect_refused(write_pixels(rgb, {nullptr, 10}, four),
                 {ErrorCode::kBadArgument, "alpha of 10 lanes has no data"});
  expect_refused(write_pixels(rgb, {alpha.view().data, 10}, three),
                 {ErrorCode::kBadArgument, "pixels of 3 channels have none for alpha"});
  expect_refused(write_pixels(rgb, {}, grey), {ErrorCode::kBadArgument, "give one plane three times"});
  const ColorSpan span = rgb.span();
  expect_refused(read_pixels(three, {{span.c[0], span.c[1] + 1, span.c[2]}, 10}),
                 {ErrorCode::kBadArgument, "multiple of 64 bytes"});
  expect_refused(PixelArray::interleaved(std::span<const float>(memory), 5),
                 {ErrorCode::kBadArgument, "not 5"});
  expect_refused(PixelArray::interleaved(std::span<const float>(memory), 3),
                 {ErrorCode::kSizeMismatch, "256 values are no multiple of 3 channels"});
  EXPECT_TRUE(std::all_of(memory.begin(), memory.end(), [](float v) { return v == 5.0F; }));
}

TEST(ArrayErrors, OfSamples) {
  std::vector<float> memory(1000, 5.0F);
  auto spectra = *SampledSpectra::create(*SpectralAxis::own_wavelengths(4), 10);
  const MutableSampleArray good{memory.data(), ElementType::kFloat, 10, 4, 4, 1};
  const auto expect = [&](MutableSampleArray array, const Refused& want) {
    expect_refused(read_samples(array, spectra), want);
    expect_refused(write_samples(spectra, array), want);
  };
  MutableSampleArray bad = good;
  bad.samples = 5;
  expect(bad, {ErrorCode::kBandsMismatch, "the array has 5 samples a lane, the batch has 4 wavelengths"});
  bad = good;
  bad.lanes = 9;
  expect(bad, {ErrorCode::kSizeMismatch, "the array has 9 lanes, the batch 10"});
  bad = good;
  bad.type = ElementType::kUint16;
  expect(bad, {ErrorCode::kBadArgument, "not integers of 2 bytes"});
  bad = good;
  bad.lane_stride = 3;
  expect(bad, {ErrorCode::kBadArgument,
               "10 lanes at a stride of 12 bytes, of 4 samples at a stride of 4 bytes, overlap"});
  bad.lane_stride = 0;
  expect(bad, {ErrorCode::kBadArgument, "a lane stride of 0 bytes"});
  bad.lane_stride = std::numeric_limits<std::ptrdiff_t>::max() / 3;
  expect(bad, {ErrorCode::kBadArgument, "exceed the memory"});
  bad = good;
  bad.data = nullptr;
  expect(bad, {ErrorCode::kBadArgument, "the array of 10 lanes has no data"});
  EXPECT_TRUE(std::all_of(memory.begin(), memory.end(), [](float v) { return v == 5.0F; }));
  EXPECT_TRUE(read_samples(good, spectra));
  expect_refused(SampleArray::lane_rows(std::span<const float>(memory), 0),
                 {ErrorCode::kBadArgument, "0 samples"});
  expect_refused(SampleArray::sample_rows(std::span<const float>(memory), 3),
                 {ErrorCode::kSizeMismatch, "1000 values are no multiple of 3 samples"});
}

}  // namespace
}  // namespace spectile::test
