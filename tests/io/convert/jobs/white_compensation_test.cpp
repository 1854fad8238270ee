// The tint that narrow bands give to white: how much of it projection takes out, without a step anywhere, and
// that it says so.
#include "tests/io/channels/spectral_files.hpp"

namespace spectile::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class WhiteCompensation : public SpectralFiles {
 protected:
  /// Projects a flat reflectance of 0.5 on bands of 20 nm from `first` on, whose XYZ by sums of the test are
  /// returned.
  Xyz project_flat(double first, ColorTarget target, std::vector<std::string>& notes) {
    const MeasuredSpectrum d65 = *illuminant("D65");
    Picture picture = blank(1, 1);
    double lower = first;
    for (; lower < 700; lower += 20) {
      picture.add(fmt::format("T.{:.6f}nm", lower + 10), Imf::FLOAT, [](int, int) { return 0.5; });
    }
    ProjectImageOptions options = xyz();
    options.target = target;
    notes = project(picture, options).notes;
    Xyz out{};
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = integral(first, lower, [&](double nm) { return d65.at(nm) * matching(k, nm); });
    for (std::size_t k : {0U, 2U, 1U}) out[k] *= 0.5 / out[1];
    return out;
  }
  Xyz rgb() const {
    const Picture got = read_picture(out_);
    return {got.at("R", 0, 0), got.at("G", 0, 0), got.at("B", 0, 0)};
  }
};

TEST_F(WhiteCompensation, NeverTouchesXyz) {
  std::vector<std::string> notes;
  for (const double first : {390.5, 425.5, 427.5, 460.0}) {
    expect_pixel(project_flat(first, ColorTarget::kXyz, notes), 1e-5);
    EXPECT_THAT(notes, Not(Contains(HasSubstr("tint"))));
  }
}

/// .5 .5 .5 with bands from 425.5 nm and .490 .509 .443 from 427.5 was a cliff.
TEST_F(WhiteCompensation, HasNoCliff) {
  std::vector<std::string> notes;
  Xyz before{};
  for (double first = 380.5; first < 470; first += 0.5) {
    const Xyz sums = project_flat(first, ColorTarget::kSrgb, notes);
    const Xyz now = rgb();
    // IEC 61966-2-1: the grey as it would be without compensation.
    const double bare[3] = {3.2404542 * sums[0] - 1.5371385 * sums[1] - 0.4985314 * sums[2],
                            -0.9692660 * sums[0] + 1.8760108 * sums[1] + 0.0415560 * sums[2],
                            0.0556434 * sums[0] - 0.2040259 * sums[1] + 1.0572252 * sums[2]};
    double off = 0;
    for (const double v : bare) off = std::max(off, std::abs(2 * v - 1));
    for (std::size_t k = 0; k < 3; ++k) {
      if (first > 380.5) {
        EXPECT_NEAR(now[k], before[k], 0.012) << first << " " << k;
      }
      if (off < 0.1) {
        EXPECT_NEAR(now[k], 0.5, 2e-6) << first << " " << k;
      }
      if (off > 0.3) {
        EXPECT_NEAR(now[k], bare[k], 2e-4) << first << " " << k;
      }
      // Between grey and what the bands alone would give.
      EXPECT_LE(std::abs(now[k] - 0.5), std::abs(bare[k] - 0.5) + 2e-4) << first << " " << k;
    }
    if (std::abs(off - 0.1) > 1e-3) {
      const auto said = Contains(HasSubstr("of the tint that this gives to white"));
      if (off > 0.1) {
        EXPECT_THAT(notes, said) << first;
      } else {
        EXPECT_THAT(notes, Not(said)) << first;
      }
    }
    before = now;
  }
}

}  // namespace
}  // namespace spectile::test
