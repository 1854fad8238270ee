// Inputs that rapidcheck draws, and objects that are expensive to make, made once.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <map>
#include <numeric>
#include <spectile/spectile.hpp>
#include <tuple>

#include "tests/support/lanes.hpp"

namespace spectile::test {

/// Rounding error of one operation, relative.
inline constexpr double kU = 0x1p-24;
/// Bound of (1 + u)^n - 1 over n u, for any n here.
inline constexpr double kHigherOrders = 1 + 0x1p-16;

/// rapidcheck reads the variable at the first property.
inline const int kLawsSeeded = ::setenv("RC_PARAMS", "seed=20240229 max_success=200", 0);

/// Lanes around the vector widths; rarely those of many blocks.
inline std::size_t drawn_lanes() {
  return *rc::gen::weightedElement<std::size_t>({{5, 1}, {5, 15}, {5, 16}, {5, 17}, {1, 4099}});
}
inline Execution drawn_execution() {
  return {*rc::gen::element(1, 2), *rc::gen::element<std::size_t>(64, 16384)};
}
inline std::mt19937 drawn_random() {
  return std::mt19937(*rc::gen::arbitrary<std::uint32_t>());
}

/// Multiples of 2^-`bits` from low to high.
class GridFloats {
 public:
  GridFloats(std::mt19937 random, int low, int high, int bits)
      : random_(random), pick_(low << bits, high << bits), step_(std::ldexp(1.0F, -bits)) {}
  float operator()() { return static_cast<float>(pick_(random_)) * step_; }

 private:
  std::mt19937 random_;
  std::uniform_int_distribution<int> pick_;
  float step_;
};

/// Any floats: bits of any kind, special values, ordinary numbers.
class ArbitraryFloat {
 public:
  explicit ArbitraryFloat(std::mt19937 random) : random_(random) {}
  float operator()() {
    const std::uint32_t kind = random_() % 3;
    if (kind == 0) return special_values()[random_() % special_values().size()];
    if (kind == 1) return std::bit_cast<float>(static_cast<std::uint32_t>(random_()));
    return static_cast<float>(random_()) * 0x1p-32F;
  }

 private:
  std::mt19937 random_;
};

template <class Draw>
SampledSpectra drawn_spectra(const Bands& bands, std::size_t lanes, Draw draw) {
  return batch_of(bands, lanes, [&](std::size_t, std::size_t) { return draw(); });
}
template <class Draw>
ColorLanes drawn_colors(std::size_t lanes, Draw draw) {
  auto out = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out.at(i, k) = draw();
  }
  return out;
}
template <class Change>
ColorLanes each_component(const ColorLanes& from, Change change) {
  auto out = *ColorLanes::create(from.lanes());
  for (std::size_t i = 0; i < from.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) out.at(i, k) = change(from.at(i, k));
  }
  return out;
}

inline std::vector<std::size_t> drawn_order(std::size_t n) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random = drawn_random();
  std::shuffle(order.begin(), order.end(), random);
  return order;
}
inline ColorLanes permuted(const ColorLanes& from, const std::vector<std::size_t>& order) {
  auto out = *ColorLanes::create(from.lanes());
  for (std::size_t i = 0; i < from.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) out.at(i, k) = from.at(order[i], k);
  }
  return out;
}
inline SampledSpectra permuted(const SampledSpectra& from, const std::vector<std::size_t>& order) {
  return batch_of(from.axis(), from.lanes(),
                  [&](std::size_t lane, std::size_t band) { return from.at(order[lane], band); });
}
inline bool same_colors(const ColorLanes& a, const ColorLanes& b) {
  for (std::size_t i = 0; i < a.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!same_bits(a.at(i, k), b.at(i, k))) return false;
    }
  }
  return true;
}

/// Bands for which the exact methods exist.
inline Bands drawn_bands() {
  return *Bands::parse(*rc::gen::element<std::string>("400:700:5", "380:780:5", "400:700:10"));
}
inline std::string drawn_light() {
  return *rc::gen::elementOf(illuminant_names());
}
inline Observer drawn_observer() {
  return *rc::gen::element(Observer::kCie1931, Observer::kCie1964);
}

/// A projector of each kind, for any light and observer.
inline Projector drawn_projector(const Bands& bands) {
  const Observer observer = drawn_observer();
  if (*rc::gen::inRange(0, 4) == 0) return *Projector::emissive(bands, observer);
  return *Projector::reflective(bands, *illuminant(drawn_light()), observer);
}

/// An upsampler, made once for the settings.
inline const Upsampler& upsampler_for(Method method, Quantity quantity, const Bands& bands,
                                      NegativeSamples negative = NegativeSamples::kClampToZero) {
  static std::map<std::tuple<Method, Quantity, std::string, NegativeSamples>, Upsampler> made;
  const auto key = std::make_tuple(method, quantity, bands.description(), negative);
  const auto found = made.find(key);
  if (found != made.end()) return found->second;
  return made.emplace(key, *Upsampler::create(method, quantity, bands, negative)).first->second;
}
inline Quantity drawn_quantity() {
  return *rc::gen::element(Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant);
}
inline NegativeSamples drawn_negative() {
  return *rc::gen::element(NegativeSamples::kClampToZero, NegativeSamples::kKeep);
}
inline Method drawn_method() {
  return *rc::gen::element(Method::kSmits, Method::kSmits1999, Method::kSmitsExact, Method::kMallett,
                           Method::kSigmoid, Method::kSigmoidObserver, Method::kTetrahedral);
}
inline Method drawn_mixture() {
  return *rc::gen::element(Method::kSmits, Method::kSmits1999, Method::kSmitsExact, Method::kMallett);
}
inline Method drawn_exact() {
  return *rc::gen::element(Method::kSmitsExact, Method::kMallett, Method::kSigmoid, Method::kSigmoidObserver,
                           Method::kTetrahedral);
}

inline SampledSpectra upsampled(const Upsampler& upsampler, const ColorLanes& rgb) {
  auto out = *SampledSpectra::create(upsampler.bands(), rgb.lanes());
  RC_ASSERT(bool(upsample_srgb(upsampler, rgb.view(), out.span(), StoreHint::kAuto, drawn_execution())));
  return out;
}
inline ColorLanes projected(const Projector& projector, const SampledSpectra& spectra) {
  auto out = *ColorLanes::create(spectra.lanes());
  RC_ASSERT(bool(project(projector, spectra.view(), out.span(), drawn_execution())));
  return out;
}

/// Keeps the largest ratio of an error to its bound; what is no number counts as infinite.
class Worst {
 public:
  void add(double error, double bound) {
    const double ratio = error <= bound && bound == 0 ? 0 : std::abs(error) / bound;
    worst_ = std::isnan(ratio) ? std::numeric_limits<double>::infinity() : std::max(worst_, ratio);
  }
  double ratio() const { return worst_; }

 private:
  double worst_ = 0;
};

}  // namespace spectile::test
