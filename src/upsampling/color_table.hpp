// ColorTable: the coefficients of every colour that was solved, so that each is solved once.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <spectile/upsampling/upsample.hpp>
#include <vector>

#include "kernels/abi.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile::rows {

/// Colours by the bits of their RGB, with what gamut_clip() and solve() make of them: the same bits, since
/// those take every lane by itself. Several threads share a table, each with a batch of its own. A table that
/// is full, or that finds too little, leaves colours to be solved as they come.
class ColorTable {
 public:
  /// The colours that one thread has under way.
  class Batch {
   public:
    /// For up to `lanes` lanes between begin() and finish(). Errors: kOutOfMemory.
    static Result<Batch> create(std::size_t lanes);

    std::uint64_t looked_up = 0;     ///< lanes
    std::uint64_t solved = 0;        ///< colours
    std::uint64_t lanes_solved = 0;  ///< with those that fill up blocks

    double solving_seconds = 0;  ///< without finding and keeping

   private:
    friend class ColorTable;
    FloatBuffer memory_;
    float* rgb_[3] = {nullptr, nullptr, nullptr};
    float* c_[4] = {nullptr, nullptr, nullptr, nullptr};
    std::vector<std::uint64_t> unsolved_;
    std::vector<std::uint8_t> outside_;
    std::vector<std::uint32_t> hash_;
    std::vector<std::int64_t> place_;    // a lane's: an entry of the table, or -1 - its place in the batch
    std::vector<std::int64_t> claimed_;  // a colour's entry, or -1
    std::size_t lanes_ = 0;
    std::size_t colors_ = 0;
    std::uint64_t recent_lanes_ = 0;
    std::uint64_t recent_colors_ = 0;
    int idle_lines_ = 0;  // left of the back-off
    int back_off_ = 0;    // lines without the table, the next time
  };

  /// `lanes`: all that will be looked up; the table is no larger than they can need.
  ColorTable(const kernels::KernelTable& kernels, const Upsampler& upsampler, GamutPolicy policy,
             std::uint64_t lanes);

  /// True if the table pays for the next line; asked once a line.
  bool worth_while(Batch& batch) const;

  /// Looks for `n` lanes' colours, which become the batch's next lanes.
  void add(Batch& batch, const float* const rgb[3], std::size_t n);
  /// Solves those that nobody had, once all lanes of a line are there.
  void solve(Batch& batch);
  /// The coefficients of `n` lanes from the batch's lane `first` on. `outside` [n]: 1 for colours
  /// that the method cannot make.
  void take(const Batch& batch, std::size_t first, std::size_t n, const Coefficients& out,
            std::uint8_t* outside) const;
  /// Makes the batch empty.
  static void clear(Batch& batch);

 private:
  /// A colour's entry belongs to whoever turned it from free to claimed, until it is ready.
  struct Entry {
    std::atomic<std::uint32_t> state{0};
    std::uint32_t rgb[3];
    float c[4];
  };
  std::int64_t find(const std::uint32_t rgb[3], std::uint32_t hash, bool& claimed);

  const kernels::KernelTable& kernels_;
  const Upsampler& upsampler_;
  GamutPolicy policy_;
  std::unique_ptr<Entry[]> entries_;
  std::uint32_t mask_;
};

}  // namespace spectile::rows
