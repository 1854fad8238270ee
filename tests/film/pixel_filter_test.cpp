// Pixel filters: shapes as published, integrals against brute force, and text.
#include "tests/film/filter_support.hpp"

namespace spectile::test {
namespace {

TEST(PixelFilter, IsOneAtItsCentreEvenAndZeroBeyondItsRadius) {
  for (const std::string& text : filters()) {
    const PixelFilter f = filter_of(text);
    EXPECT_DOUBLE_EQ(f(0, 0), 1) << text;
    for (const double share : {0.01, 0.1, 0.24, 0.5, 0.51, 0.77, 0.99}) {
      const double x = share * f.radius_x();
      const double y = share * f.radius_y();
      EXPECT_EQ(f.along_x(x), f.along_x(-x)) << text;
      EXPECT_EQ(f.along_y(y), f.along_y(-y)) << text;
      EXPECT_EQ(f(x, y), f.along_x(x) * f.along_y(y)) << text;
      EXPECT_LE(std::abs(f.along_x(x)), 1) << text;
    }
    for (const double share : {1 + 1e-15, 1.5, 1e9}) {
      EXPECT_EQ(f.along_x(share * f.radius_x()), 0) << text;
      EXPECT_EQ(f.along_y(-share * f.radius_y()), 0) << text;
    }
    EXPECT_EQ(f(0, kNan), 0) << text;
  }
}

TEST(PixelFilter, ABoxIsHalfOpen) {
  const PixelFilter f;
  EXPECT_EQ(f.along_x(0.5), 1);
  EXPECT_EQ(f.along_x(-0.5), 0);
  EXPECT_EQ(f.along_x(-0.5 + 1e-16), 1);
  EXPECT_EQ(f.integral(), 1);
  EXPECT_EQ(f, *PixelFilter::box());
  // So every point belongs to one pixel.
  for (const double x : {0.0, 0.25, 1.0, 1.5, 2.0}) {
    int pixels = 0;
    for (int i = -3; i < 5; ++i) pixels += f.along_x(i + 0.5 - x) == 1 ? 1 : 0;
    EXPECT_EQ(pixels, 1) << x;
  }
}

TEST(PixelFilter, ProfilesAreTheFormulas) {
  EXPECT_DOUBLE_EQ(filter_of("triangle:2").along_x(0.5), 0.75);
  const double end = std::exp(-4.5);
  EXPECT_NEAR(filter_of("gaussian:1.5:0.5").along_x(0.7), (std::exp(-0.98) - end) / (1 - end), 1e-15);
  // A wide sigma leaves a parabola.
  EXPECT_NEAR(filter_of("gaussian:2:1e+12").along_x(1), 0.75, 1e-15);
  EXPECT_NEAR(filter_of("gaussian:2:1e5").along_x(1), 0.75, 1e-10);
  const double pi = 3.14159265358979323846;
  EXPECT_NEAR(filter_of("lanczos:4:3").along_x(1.5),
              std::sin(1.5 * pi) / (1.5 * pi) * std::sin(0.5 * pi) / (0.5 * pi), 1e-15);
  for (const int whole : {1, 2, 3, 4}) EXPECT_EQ(filter_of("lanczos:4:3").along_x(whole), 0);
}

TEST(PixelFilter, MitchellIsAsPublished) {
  // b = c = 1/3: six times the published kernel is 7x^3 - 12x^2 + 16/3, then -7/3 x^3 + 12x^2 - 20x + 32/3.
  const PixelFilter f = filter_of("mitchell");
  EXPECT_NEAR(f.along_x(1), 1.0 / 16, 1e-15);
  EXPECT_NEAR(f.along_x(0.5), (7 * 0.125 - 12 * 0.25 + 16.0 / 3) / (16.0 / 3), 1e-15);
  EXPECT_NEAR(f.along_x(1.5), (-7.0 / 3 * 3.375 + 12 * 2.25 - 20 * 1.5 + 32.0 / 3) / (16.0 / 3), 1e-14);
  EXPECT_EQ(f.along_x(2), 0);
  // b = 1, c = 0 is the cubic B-spline, b = 0, c = 1/2 Catmull-Rom's, which interpolates.
  EXPECT_NEAR(filter_of("mitchell:2:1:0").along_x(1), 0.25, 1e-15);
  EXPECT_EQ(filter_of("mitchell:2:0:0.5").along_x(1), 0);
  // The radius stretches it.
  EXPECT_DOUBLE_EQ(filter_of("mitchell:3").along_x(1.5), f.along_x(1));
}

TEST(PixelFilter, IntegralsAreThoseOfBruteForce) {
  for (const std::string& text : filters()) {
    const PixelFilter f = filter_of(text);
    const auto axis = [](auto profile, double r) {
      // Kinks at 0 and half-way lie between steps; only the first half is taken.
      return 2 * (brute_force(profile, 0, r / 2) + brute_force(profile, r / 2, r));
    };
    const double want = axis([&](double d) { return f.along_x(d); }, f.radius_x()) *
                        axis([&](double d) { return f.along_y(d); }, f.radius_y());
    EXPECT_NEAR(f.integral(), want, 2e-11 * want) << text;
  }
}

TEST(PixelFilter, IntegralsAreTheClosedForms) {
  EXPECT_DOUBLE_EQ(filter_of("triangle:2x3").integral(), 6);
  EXPECT_DOUBLE_EQ(filter_of("box:2x3").integral(), 24);
  // A kernel that sums to one at whole distances has the integral 1, over 8/9 at its centre.
  EXPECT_NEAR(filter_of("mitchell").integral(), 81.0 / 64, 1e-12);
  const double end = std::exp(-4.5);
  const double gaussian =
      (0.5 * std::sqrt(2 * 3.14159265358979323846) * std::erf(3 / std::sqrt(2.0)) - 3 * end) / (1 - end);
  EXPECT_NEAR(filter_of("gaussian").integral(), gaussian * gaussian, 1e-12 * gaussian * gaussian);
}

TEST(PixelFilter, KnowsItsNegativeLobes) {
  for (const std::string& text : filters()) {
    const PixelFilter f = filter_of(text);
    bool found = false;
    for (int i = 0; i <= 10000; ++i) {
      found = found || f.along_x(f.radius_x() * i / 10000) < 0 || f.along_y(f.radius_y() * i / 10000) < 0;
    }
    EXPECT_EQ(f.has_negative_lobes(), found) << text;
  }
  EXPECT_TRUE(filter_of("mitchell").has_negative_lobes());
  EXPECT_TRUE(filter_of("mitchell:2:1:1e-12").has_negative_lobes());
  EXPECT_FALSE(filter_of("mitchell:2:1:0").has_negative_lobes());
  EXPECT_FALSE(filter_of("lanczos:1:3").has_negative_lobes());
  EXPECT_TRUE(filter_of("lanczos:1x1.5:3").has_negative_lobes());
}

TEST(PixelFilter, ComesBackFromItsText) {
  for (const std::string& text : filters()) {
    const PixelFilter f = filter_of(text);
    EXPECT_EQ(filter_of(f.to_text()), f) << text;
  }
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> number(0.02, 5);
  for (int i = 0; i < 20; ++i) {
    const auto f =
        *PixelFilter::mitchell(number(random), number(random), 0.5 * number(random), number(random));
    EXPECT_EQ(filter_of(f.to_text()), f) << f.to_text();
  }
  EXPECT_EQ(PixelFilter().to_text(), "box:0.5");
  EXPECT_EQ(filter_of("gaussian"), *PixelFilter::gaussian());
  EXPECT_EQ(filter_of("gaussian:2"), *PixelFilter::gaussian(2, 2));
  EXPECT_EQ(filter_of("lanczos:2x3:1.5"), *PixelFilter::lanczos(2, 3, 1.5));
  EXPECT_EQ(filter_of("mitchell:2x3:0.2"), *PixelFilter::mitchell(2, 3, 0.2));
  EXPECT_FALSE(filter_of("gaussian:1.5:0.5") == filter_of("gaussian:1.5:0.6"));
  EXPECT_FALSE(filter_of("box:2") == filter_of("triangle:2"));
}

TEST(PixelFilter, WhatItCannotBeIsAnErrorThatSaysWhy) {
  const auto fails = [](const std::string& text, ErrorCode wanted, const std::string& part) {
    const auto f = PixelFilter::parse(text);
    EXPECT_EQ(code_of(f), code(wanted)) << text;
    const std::string message = f ? "" : f.error().message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  fails("sinc", ErrorCode::kUnknownName,
        "\"sinc\" is unknown; there are box, triangle, gaussian, mitchell, lanczos");
  fails("", ErrorCode::kUnknownName, "there are box");
  fails("Box", ErrorCode::kUnknownName, "Box");
  fails("box:", ErrorCode::kBadArgument, "\"\" is not a finite number");
  fails("box:0", ErrorCode::kBadArgument, "radius of 0 pixels");
  fails("box:-1", ErrorCode::kBadArgument, "-1");
  fails("box:nan", ErrorCode::kBadArgument, "nan");
  fails("box:65", ErrorCode::kBadArgument, "65");
  fails("box:1x", ErrorCode::kBadArgument, "box:1x");
  fails("box:1x2x3", ErrorCode::kBadArgument, "1x2x3");
  fails("box:1:2", ErrorCode::kBadArgument, "1 numbers too many");
  fails("triangle:0.009", ErrorCode::kBadArgument, "0.009");
  fails("gaussian:2:0", ErrorCode::kBadArgument, "sigma of 0");
  // Integrals above 0 whose product is not.
  fails("gaussian:2.38:7.74e-321", ErrorCode::kBadArgument, "their product");
  fails("gaussian:2:inf", ErrorCode::kBadArgument, "inf");
  fails("mitchell:2:3:0", ErrorCode::kBadArgument, "b = 3");
  fails("mitchell:2:1:1:1", ErrorCode::kBadArgument, "too many");
  fails("lanczos:2:-1", ErrorCode::kBadArgument, "tau of -1");
  fails("lanczos:2:1 ", ErrorCode::kBadArgument, "\"1 \"");
  EXPECT_EQ(code_of(PixelFilter::box(0.5, kNan)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(PixelFilter::gaussian(1, 1, kInf)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(PixelFilter::mitchell(1, 1, kNan, 0)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(PixelFilter::mitchell(1, 1, 0, kInf)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(PixelFilter::lanczos(1, 1, kNan)), code(ErrorCode::kBadArgument));
}

}  // namespace
}  // namespace spectile::test
