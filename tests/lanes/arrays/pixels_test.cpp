// Pixels of every type, number of channels, layout and alignment, from and to lanes.
#include <spectile/lanes/pixels.hpp>

#include "tests/lanes/arrays/caller_memory.hpp"

namespace spectile::test {
namespace {

struct PixelKind {
  const char* name;
  ElementType type;
  PixelEncoding encoding;
};
constexpr PixelKind kKinds[] = {{"float", ElementType::kFloat, PixelEncoding::kLinear},
                                {"half", ElementType::kHalf, PixelEncoding::kLinear},
                                {"8 bit", ElementType::kUint8, PixelEncoding::kLinear},
                                {"8 bit sRGB", ElementType::kUint8, PixelEncoding::kSrgb},
                                {"16 bit", ElementType::kUint16, PixelEncoding::kLinear},
                                {"16 bit sRGB", ElementType::kUint16, PixelEncoding::kSrgb}};

struct PixelLayout {
  const char* name;
  Places (*places)(std::ptrdiff_t bytes, std::ptrdiff_t channels, std::ptrdiff_t pixels);
  std::size_t shift;
};
constexpr PixelLayout kLayouts[] = {{"packed",
                                     [](auto b, auto c, auto) {
                                       return Places{c * b, b};
                                     },
                                     0},
                                    {"packed, odd address",
                                     [](auto b, auto c, auto) {
                                       return Places{c * b, b};
                                     },
                                     3},
                                    {"planar",
                                     [](auto b, auto, auto n) {
                                       return Places{b, n * b};
                                     },
                                     0},
                                    {"planar, odd address and gap",
                                     [](auto b, auto, auto n) {
                                       return Places{b, n * b + 1};
                                     },
                                     1},
                                    {"in a struct",
                                     [](auto b, auto c, auto) {
                                       return Places{c * b + 16, b};
                                     },
                                     8},
                                    {"in a struct of odd size",
                                     [](auto b, auto c, auto) {
                                       return Places{c * b + 5, b};
                                     },
                                     2},
                                    {"channels apart",
                                     [](auto b, auto c, auto) {
                                       return Places{3 * c * b, 2 * b};
                                     },
                                     0},
                                    {"from the last pixel",
                                     [](auto b, auto c, auto) {
                                       return Places{-c * b, b};
                                     },
                                     0},
                                    {"from the last channel",
                                     [](auto b, auto c, auto) {
                                       return Places{c * b, -b};
                                     },
                                     4}};

/// A view with every particular of one case, and the memory that it is of.
struct PixelCase {
  PixelCase(const PixelKind& kind, const PixelLayout& layout, std::size_t channels, std::size_t pixels)
      : name(std::string(kind.name) + ", " + layout.name + ", " + std::to_string(channels) + " channels, " +
             std::to_string(pixels) + " pixels"),
        places(layout.places(static_cast<std::ptrdiff_t>(bytes_of(kind.type)),
                             static_cast<std::ptrdiff_t>(channels), static_cast<std::ptrdiff_t>(pixels))),
        memory(kind.type, pixels, channels, places, layout.shift),
        view{memory.data(), pixels, kind.type, channels, places.lane, places.sample, kind.encoding} {}
  bool srgb(std::size_t channel) const { return view.encoding == PixelEncoding::kSrgb && channel < 3; }

  std::string name;
  Places places;
  CallerMemory memory;
  MutablePixelArray view;
};

void for_every_case(const std::function<void(PixelCase&)>& work) {
  for (const PixelKind& kind : kKinds) {
    for (const PixelLayout& layout : kLayouts) {
      for (const std::size_t channels : {1, 3, 4}) {
        for (const std::size_t pixels : kArraySizes) {
          PixelCase one(kind, layout, channels, pixels);
          SCOPED_TRACE(one.name);
          work(one);
          if (testing::Test::HasFatalFailure()) return;
        }
      }
    }
  }
}

TEST(Pixels, AreReadFromEveryLayout) {
  for_every_case([](PixelCase& one) {
    const std::size_t n = one.view.pixels;
    const std::size_t channels = one.view.channels;
    one.memory.fill(7);
    const auto before = one.memory.copy();
    std::vector<float> want(4 * n, 1.0F);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < channels; ++c)
        want[4 * i + c] = decoded(one.view.type, one.srgb(c), one.memory.get(i, c));
      if (channels == 1) want[4 * i + 1] = want[4 * i + 2] = want[4 * i];
    }
    on_every_setting([&](const Execution& execution) {
      auto rgb = *ColorLanes::create(n);
      auto alpha = *ScalarLanes::create(n);
      for (std::size_t i = 0; i < blocks_for(n) * kLanesPerBlock; ++i)
        rgb.at(i, 0) = rgb.at(i, 1) = rgb.at(i, 2) = alpha[i] = 9;
      ASSERT_TRUE(read_pixels(one.view, rgb, alpha, execution));
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_TRUE(same_bits(c < 3 ? rgb.at(i, c) : alpha[i], want[4 * i + c])) << i << " channel " << c;
      }
      for (const float* plane : rgb.view().c) ASSERT_TRUE(padding_is_zero(plane, n));
      ASSERT_TRUE(padding_is_zero(alpha.view().data, n));
    });
    ASSERT_EQ(one.memory.copy(), before);
  });
}

TEST(Pixels, AreWrittenToEveryLayoutAndNowhereElse) {
  for_every_case([](PixelCase& one) {
    const std::size_t n = one.view.pixels;
    const std::size_t channels = one.view.channels;
    auto rgb = *ColorLanes::create(n);
    auto alpha = *ScalarLanes::create(n);
    const Floats values = arbitrary_floats(4 * n, 11);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < 3; ++c) rgb.at(i, c) = values[4 * i + c];
      alpha[i] = values[4 * i + 3];
    }
    std::vector<std::uint32_t> want(channels * n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < channels; ++c)
        want[i * channels + c] = encoded(one.view.type, one.srgb(c), values[4 * i + c]);
    }
    ColorView color = rgb.view();
    if (channels == 1) color.c[1] = color.c[2] = color.c[0];
    on_every_setting([&](const Execution& execution) {
      one.memory.fill(13);
      ASSERT_TRUE(write_pixels(color, channels == 4 ? alpha.view() : LanesView{}, one.view, execution));
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t c = 0; c < channels; ++c)
          ASSERT_TRUE(same_element(one.view.type, one.memory.get(i, c), want[i * channels + c]))
              << "pixel " << i << " channel " << c << " of " << values[4 * i + c] << ": "
              << one.memory.get(i, c) << ", not " << want[i * channels + c];
      }
      ASSERT_TRUE(one.memory.guards_hold());
    });
  });
}

TEST(Pixels, NothingBehindTheLastIsTouched) {
  for (const PixelKind& kind : kKinds) {
    for (const std::size_t channels : {3, 4}) {
      for (const std::size_t n : {1, 16, 64, 65, 128}) {
        const auto bytes = static_cast<std::ptrdiff_t>(bytes_of(kind.type));
        const auto pixel = static_cast<std::ptrdiff_t>(channels) * bytes;
        MemoryAtPageEnd memory(n * channels * bytes_of(kind.type));
        const MutablePixelArray array{memory.data(), n, kind.type, channels, pixel, bytes, kind.encoding};
        on_every_setting([&](const Execution& execution) {
          auto rgb = *ColorLanes::create(n);
          ASSERT_TRUE(read_pixels(array, rgb, {}, execution));
          ASSERT_TRUE(write_pixels(rgb, {}, array, execution));
        });
      }
    }
  }
}

TEST(Pixels, FloatsGoThroughBitByBit) {
  for (const std::size_t channels : {3, 4}) {
    std::vector<float> in(channels * 1000);
    for (std::size_t i = 0; i < in.size(); ++i)
      in[i] = std::bit_cast<float>(static_cast<std::uint32_t>(i * 2654435761U));
    in[5] = std::bit_cast<float>(0x7F812345U);  // a signalling NaN
    std::vector<float> out(in.size());
    auto rgb = *ColorLanes::create(1000);
    auto alpha = *ScalarLanes::create(1000);
    ASSERT_TRUE(read_pixels(*PixelArray::interleaved(in, channels), rgb, alpha));
    ASSERT_TRUE(write_pixels(rgb, channels == 4 ? alpha.view() : LanesView{},
                             *MutablePixelArray::interleaved(out, channels)));
    EXPECT_EQ(std::memcmp(in.data(), out.data(), in.size() * sizeof(float)), 0);
  }
}

TEST(Pixels, WithoutAlphaAreOpaque) {
  auto rgb = *ColorLanes::create(65);
  std::vector<float> floats(4 * 65);
  std::vector<std::uint8_t> bytes(4 * 65);
  std::vector<std::uint16_t> words(4 * 65);
  std::vector<std::uint16_t> halves(4 * 65);
  ASSERT_TRUE(write_pixels(rgb, {}, *MutablePixelArray::interleaved(floats, 4)));
  ASSERT_TRUE(write_pixels(rgb, {}, *MutablePixelArray::interleaved(bytes, 4, PixelEncoding::kSrgb)));
  ASSERT_TRUE(write_pixels(rgb, {}, *MutablePixelArray::interleaved(words, 4, PixelEncoding::kLinear)));
  ASSERT_TRUE(write_pixels(rgb, {}, *MutablePixelArray::interleaved_halves(halves, 4)));
  for (std::size_t i = 0; i < 65; ++i) {
    EXPECT_EQ(floats[4 * i + 3], 1);
    EXPECT_EQ(bytes[4 * i + 3], 255);
    EXPECT_EQ(words[4 * i + 3], 65535);
    EXPECT_EQ(halves[4 * i + 3], 0x3C00);
  }
}

TEST(Pixels, OfOneChannelCanBeTheAlphaOfOthers) {
  const std::vector<std::uint8_t> bgra = {10, 20, 30, 40, 50, 60, 70, 80};
  const PixelArray color{&bgra[2], 2, ElementType::kUint8, 3, 4, -1, PixelEncoding::kLinear};
  const PixelArray fourth{&bgra[3], 2, ElementType::kUint8, 1, 4, 1, PixelEncoding::kLinear};
  auto rgb = *ColorLanes::create(2);
  auto alpha = *ScalarLanes::create(2);
  float* const plane = alpha.span().data;
  ASSERT_TRUE(read_pixels(color, rgb));
  ASSERT_TRUE(read_pixels(fourth, {{plane, plane, plane}, 2}));
  EXPECT_EQ(rgb.at(1, 0), 70 / 255.0F);
  EXPECT_EQ(rgb.at(1, 2), 50 / 255.0F);
  EXPECT_EQ(alpha[1], 80 / 255.0F);
}

TEST(Pixels, NoneAtAllAreNoError) {
  auto rgb = *ColorLanes::create(0);
  EXPECT_TRUE(read_pixels({}, rgb));
  EXPECT_TRUE(write_pixels(rgb, {}, {}));
}

}  // namespace
}  // namespace spectile::test
