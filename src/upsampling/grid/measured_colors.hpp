// Steps that learning nodes and evaluating them have in common.
#pragma once

#include <spectile/upsampling/learned_nodes.hpp>

#include "src/color/working_space.hpp"

namespace spectile {

/// Errors: kBadArgument for sets of too few reflectances together, or too many.
Result<void> check_sizes(std::span<const ReflectanceSet> sets);

/// learn_nodes() from at least one reflectance, for parts of sets. Throws: std::bad_alloc.
Result<LearnedNodes> learn_from(std::span<const ReflectanceSet> sets, const LearningOptions& options);

/// From reflectances to RGB with the primaries of sRGB, over bands of 5 nm from 380 to 780 nm.
class MeasuredColors {
 public:
  /// Errors: those of working_space().
  static Result<MeasuredColors> create(const LearningOptions& options);
  const Bands& bands() const noexcept { return bands_; }
  std::array<double, 3> rgb_of(const Spectrum& reflectance) const;
  Lab lab_of(const std::array<double, 3>& rgb) const;

 private:
  MeasuredColors() = default;
  Bands bands_;
  WorkingSpace space_;
};

}  // namespace spectile
