// Evaluators: how samples at wavelengths come from the channels of a strip, for textures.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kernels/abi.hpp"
#include "src/io/exr/strips.hpp"
#include "src/upsampling/sampled_rows.hpp"

namespace spectile::io {

/// Pixels side by side on one line; evaluators take up to kLanesPerBlock.
struct Piece {
  const Strip& strip;
  int line;
  std::size_t x;  // of the first pixel
  std::size_t n;
};

/// The piece's samples of a plane as floats, at a multiple of 64 bytes; zeros up to a whole block.
void load_plane(const kernels::KernelTable& kernels, const Piece& piece, std::size_t plane, SampleType type,
                float* to);

/// How the samples asked for come from the planes of a strip.
class Evaluator {
 public:
  virtual ~Evaluator() = default;
  /// Channels that the strips must hold.
  virtual const std::vector<PlaneSpec>& planes() const = 0;
  /// Makes a piece's samples; out[band] takes piece.n floats, at any address.
  virtual void piece(const kernels::KernelTable& kernels, const Piece& piece, void* const* out) const = 0;
};

/// Coefficients through the rows of a method; NaN where they are not finite or their samples could overflow.
class CompactEvaluator : public Evaluator {
 public:
  CompactEvaluator(rows::SampledRows rows, std::vector<PlaneSpec> planes)
      : rows_(std::move(rows)), planes_(std::move(planes)) {}
  const std::vector<PlaneSpec>& planes() const override { return planes_; }
  void piece(const kernels::KernelTable& kernels, const Piece& piece, void* const* out) const override;

 private:
  rows::SampledRows rows_;
  std::vector<PlaneSpec> planes_;
};

/// Stored samples, linear between the centres of their bands; takes the channels next to the wavelengths
/// only.
class FullEvaluator : public Evaluator {
 public:
  /// `channels` are those of all `bands`; the wavelengths ascend.
  FullEvaluator(const Bands& bands, const std::vector<PlaneSpec>& channels,
                std::span<const double> wavelengths_nm);
  const std::vector<PlaneSpec>& planes() const override { return planes_; }
  void piece(const kernels::KernelTable& kernels, const Piece& piece, void* const* out) const override;

 private:
  /// (1 - t) first + t second, of planes; the first alone where both are the same.
  struct Mixture {
    std::size_t first = 0;
    std::size_t second = 0;
    float t = 0;
  };
  std::size_t plane(const PlaneSpec& channel);
  std::vector<PlaneSpec> planes_;
  std::vector<Mixture> mixtures_;
};

}  // namespace spectile::io
