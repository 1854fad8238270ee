// Film::add: checks of a batch, and its way chunk by chunk through weighing and placing to the tiles.
#include <algorithm>
#include <limits>
#include <mutex>

#include "src/base/out_of_memory.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/film/entries.hpp"
#include "src/film/scratch.hpp"
#include "src/film/state.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using kernels::kFilmAccepted;
using kernels::kFilmReasons;
using kernels::kLanes;
using State = FilmAccess::State;

/// Samples that are weighed at once: their quads stay in the first-level cache.
constexpr std::size_t kChunk = 1024;
static_assert(kChunk % kLanes == 0);

/// One over the range of visible wavelengths, about: an even density makes it the weight of a hit.
constexpr float kReferenceDensity = 1.0F / 512;

/// Rows of samples in pieces of a block's lanes.
struct PieceRows {
  const float* data = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;             ///< floats from row to row
  std::size_t piece_stride = kLanes;  ///< floats from a row's piece to its next one
  bool padded = false;                ///< the last piece is whole in memory
};

PieceRows rows_of(const RowsView& rows) {
  return {rows.data, rows.count, rows.stride, kLanes, false};
}

PieceRows rows_of(const SampledSpectraView& batch) {
  return {batch.data, batch.axis.count(), kLanes, batch.axis.count() * kLanes, true};
}

/// A batch as the kernels take it, from one sample on.
struct Batch {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* weight = nullptr;  ///< null for 1
  PieceRows radiance, lambda_nm, density;
};

/// From sample `first` on, the first of a block.
void rows_from(const PieceRows& rows, std::size_t first, std::vector<const float*>& out) {
  out.resize(rows.count);
  for (std::size_t k = 0; k < rows.count; ++k) {
    out[k] = rows.data + k * rows.stride + first / kLanes * rows.piece_stride;
  }
}

/// Points the scratch's rows at samples `first` on; where they are fewer than whole blocks, at a copy of them
/// with zeros behind.
Result<Batch> padded_chunk(const Batch& batch, std::size_t first, std::size_t n, FilmScratch& scratch) {
  Batch out = batch;
  out.x += first;
  out.y += first;
  if (out.weight != nullptr) out.weight += first;
  rows_from(batch.radiance, first, scratch.radiance);
  rows_from(batch.lambda_nm, first, scratch.lambda_nm);
  rows_from(batch.density, first, scratch.density);
  const std::size_t whole = blocks_for(n) * kLanes;
  if (n == whole) return out;
  const std::size_t rows = 3 + batch.radiance.count + batch.lambda_nm.count + batch.density.count;
  if (scratch.padded.size() < rows * kChunk) {
    SPECTILE_ASSIGN(scratch.padded, FloatBuffer::create(rows * kChunk));
  }
  float* to = scratch.padded.data();
  const auto copy = [&](const float*& row) {
    if (row == nullptr) return;
    std::copy_n(row, n, to);
    std::fill(to + n, to + whole, 0.0F);
    row = to;
    to += whole;
  };
  copy(out.x);
  copy(out.y);
  copy(out.weight);
  if (batch.radiance.padded) return out;
  for (auto* const list : {&scratch.radiance, &scratch.lambda_nm, &scratch.density}) {
    for (const float*& row : *list) copy(row);
  }
  return out;
}

Result<void> make_room(const State& s, std::size_t wavelengths, FilmScratch& scratch) {
  const auto floats = [](FloatBuffer& buffer, std::size_t count) -> Result<void> {
    if (buffer.size() >= count) return {};
    SPECTILE_ASSIGN(buffer, FloatBuffer::create(count));
    return {};
  };
  scratch.quad_floats = 4 * kChunk;
  SPECTILE_TRY(floats(scratch.quads, s.layout.quads * scratch.quad_floats));
  if (s.layout.bands > 0 && s.layout.own_weights) {
    SPECTILE_TRY(floats(scratch.hits, 2 * wavelengths * kChunk));
    scratch.band.resize(wavelengths * kChunk);
  } else if (s.layout.bands > 0) {
    SPECTILE_TRY(floats(scratch.band_quads, 4 * s.layout.band_quads() * kChunk));
  }
  scratch.reasons.resize(kChunk);
  scratch.more_reasons.resize(kChunk);
  scratch.address.resize(kChunk);
  return {};
}

/// Everything that samples contribute, into the scratch, and the reasons why some do not.
void weigh(const State& s, const kernels::KernelTable& table, const Batch& batch, std::size_t n,
           FilmScratch& scratch) {
  const kernels::FilmSamples samples = {scratch.radiance.data(),    scratch.lambda_nm.data(),
                                        scratch.density.data(),     batch.weight,
                                        batch.radiance.count,       n,
                                        batch.radiance.piece_stride};
  for (std::size_t c = 0; c < s.responses.size(); ++c) {
    const kernels::FilmQuads out = {scratch.quads.data() + c * scratch.quad_floats,
                                    (c == 0 ? scratch.reasons : scratch.more_reasons).data(),
                                    c == 0 && s.layout.moments};
    const float* const response = s.responses[c].table.data();
    if (s.options.input == FilmInput::kBands) {
      table.film_weigh_bands(out, samples, response, s.limits);
    } else {
      const kernels::FilmCurves curves = {response, static_cast<float>(kFirstVisibleNm),
                                          static_cast<std::int32_t>(kLastVisibleNm - kFirstVisibleNm),
                                          s.responses[c].largest};
      table.film_weigh_wavelengths(out, samples, curves, s.limits, 1.0F / static_cast<float>(samples.count));
    }
    // Faults are the same for all; what is beyond the range may differ.
    for (std::size_t i = 0; c > 0 && i < n; ++i) {
      if (scratch.reasons[i] == kFilmAccepted) scratch.reasons[i] = scratch.more_reasons[i];
    }
  }
  if (s.layout.bands == 0) return;
  if (s.layout.own_weights) {
    table.film_hits({scratch.band.data(), scratch.hits.data(), scratch.reasons.data()}, samples, s.buckets,
                    s.limits, kReferenceDensity);
  } else {
    table.film_band_quads(scratch.band_quads.data(), 4 * s.layout.band_quads(), scratch.reasons.data(),
                          samples, s.limits);
  }
}

Result<void> add_chunk(State& s, const kernels::KernelTable& table, const Batch& whole, std::size_t first,
                       std::size_t n, FilmScratch& scratch) {
  SPECTILE_ASSIGN(const auto batch, padded_chunk(whole, first, n, scratch));
  const std::size_t padded = blocks_for(n) * kLanes;
  weigh(s, table, batch, padded, scratch);
  std::array<std::uint64_t, kFilmReasons> counts{};
  const FilmContributions contributions = {.wavelengths = whole.radiance.count, .samples = padded};
  if (s.options.placement == SamplePlacement::kOnePixel) {
    std::int32_t tiles[2] = {std::numeric_limits<std::int32_t>::max(), -1};
    table.film_place({scratch.address.data(), tiles, counts.data()}, s.kernel_window,
                     {batch.x, batch.y, batch.weight, scratch.reasons.data(), n});
    SPECTILE_TRY(add_entries(s, table, contributions,
                             {.sample = nullptr,
                              .address = scratch.address.data(),
                              .factor = nullptr,
                              .count = n,
                              .tile = tiles[0] == tiles[1] ? tiles[0] : -1},
                             scratch));
  } else {
    SPECTILE_TRY(splat(s, table, contributions, batch.x, batch.y, batch.weight, n, counts, scratch));
  }
  for (std::size_t r = 0; r < kFilmReasons; ++r) {
    if (counts[r] > 0) s.counts[r].fetch_add(counts[r], std::memory_order_relaxed);
  }
  return {};
}

/// Scratch of a film, for as long as this lives.
class ScratchLease {
 public:
  explicit ScratchLease(State& s) : state_(s) {
    {
      const std::scoped_lock lock(s.scratch_mutex);
      if (!s.scratch.empty()) {
        scratch_ = std::move(s.scratch.back());
        s.scratch.pop_back();
      }
    }
    if (!scratch_) scratch_ = std::make_unique<FilmScratch>();
  }
  ScratchLease(const ScratchLease&) = delete;
  ScratchLease& operator=(const ScratchLease&) = delete;
  ~ScratchLease() {
    const std::scoped_lock lock(state_.scratch_mutex);
    try {
      state_.scratch.push_back(std::move(scratch_));
    } catch (...) {  // no memory to keep it in: it is freed
    }
  }
  FilmScratch& operator*() { return *scratch_; }

 private:
  State& state_;
  std::unique_ptr<FilmScratch> scratch_;
};

Result<void> same_size(const char* what, std::size_t size, std::size_t n) {
  if (size == n) return {};
  return make_error(ErrorCode::kSizeMismatch, "the batch has {} positions and {} {}", n, size, what);
}

Result<void> rows_fit(const char* what, const RowsView& rows, std::size_t count, std::size_t n) {
  if (rows.count != count) {
    return make_error(ErrorCode::kSizeMismatch, "the batch has {} rows of radiance and {} of {}", count,
                      rows.count, what);
  }
  if (rows.count > 1 && rows.stride < n) {
    return make_error(ErrorCode::kSizeMismatch, "rows of {} are {} floats apart, for {} samples", what,
                      rows.stride, n);
  }
  return {};
}

Result<void> add_batch(State& s, const Batch& batch, std::size_t n, const Execution& execution) {
  if (n == 0) return {};
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::shared_lock lock(s.whole);
  std::mutex mutex;
  Result<void> result;
  tiles::for_blocks(blocks_for(n), execution, [&](std::size_t first_block, std::size_t blocks) {
    const auto work = [&]() -> Result<void> {
      ScratchLease scratch(s);
      SPECTILE_TRY(make_room(s, batch.radiance.count, *scratch));
      const std::size_t end = std::min(n, (first_block + blocks) * kLanes);
      for (std::size_t i = first_block * kLanes; i < end; i += kChunk) {
        SPECTILE_TRY(add_chunk(s, *table, batch, i, std::min(kChunk, end - i), *scratch));
      }
      return {};
    };
    const Result<void> done = guard_memory(work, "no memory to add {} samples", n);
    if (done) return;
    const std::scoped_lock first(mutex);
    if (result) result = done;
  });
  if (result && s.overflown) return film_overflow(s);
  return result;
}

const float* data_or_null(std::span<const float> weight) {
  return weight.empty() ? nullptr : weight.data();
}

Result<void> positions_fit(const SamplePositions& at, std::size_t lanes) {
  SPECTILE_TRY(same_size("other coordinates", at.y.size(), at.x.size()));
  if (!at.weight.empty()) SPECTILE_TRY(same_size("weights", at.weight.size(), at.x.size()));
  return same_size("lanes", lanes, at.x.size());
}

Result<void> takes(const State& s, FilmInput input) {
  if (s.options.input == input) return {};
  return make_error(
      ErrorCode::kBadArgument, "the film takes radiance {}",
      input == FilmInput::kBands ? "at wavelengths, not on bands" : "on its bands, not at wavelengths");
}

Result<void> takes_wavelengths(std::size_t count) {
  if (count > 0 && count <= SpectralAxis::kMaxWavelengths) return {};
  return make_error(ErrorCode::kBadArgument, "a sample takes 1 to {} wavelengths, not {}",
                    SpectralAxis::kMaxWavelengths, count);
}

}  // namespace

Result<void> Film::add(const WavelengthSamples& samples, const Execution& execution) {
  const std::size_t n = samples.x.size();
  SPECTILE_TRY(takes(*state_, FilmInput::kWavelengths));
  SPECTILE_TRY(positions_fit({samples.x, samples.y, samples.weight}, n));
  const std::size_t count = samples.radiance.count;
  SPECTILE_TRY(takes_wavelengths(count));
  SPECTILE_TRY(rows_fit("radiance", samples.radiance, count, n));
  SPECTILE_TRY(rows_fit("wavelengths", samples.lambda_nm, count, n));
  SPECTILE_TRY(rows_fit("densities", samples.density, count, n));
  return add_batch(*state_,
                   {samples.x.data(), samples.y.data(), data_or_null(samples.weight),
                    rows_of(samples.radiance), rows_of(samples.lambda_nm), rows_of(samples.density)},
                   n, execution);
}

Result<void> Film::add(const BandSamples& samples, const Execution& execution) {
  const std::size_t n = samples.x.size();
  SPECTILE_TRY(takes(*state_, FilmInput::kBands));
  SPECTILE_TRY(positions_fit({samples.x, samples.y, samples.weight}, n));
  if (samples.radiance.count != state_->options.bands.count()) {
    return make_error(ErrorCode::kBandsMismatch, "the batch has {} rows of radiance, the film {} bands",
                      samples.radiance.count, state_->options.bands.count());
  }
  SPECTILE_TRY(rows_fit("radiance", samples.radiance, samples.radiance.count, n));
  return add_batch(*state_,
                   {samples.x.data(), samples.y.data(), data_or_null(samples.weight),
                    rows_of(samples.radiance), PieceRows(), PieceRows()},
                   n, execution);
}

Result<void> Film::add(const SamplePositions& at, SampledSpectraView radiance,
                       const SampledWavelengthsView& wavelengths, const Execution& execution) {
  SPECTILE_TRY(takes(*state_, FilmInput::kWavelengths));
  SPECTILE_TRY(positions_fit(at, radiance.lanes));
  SPECTILE_TRY(shape::own_wavelengths(wavelengths.lambda_nm.axis));
  SPECTILE_TRY(shape::same(radiance, wavelengths.lambda_nm));
  SPECTILE_TRY(shape::same(radiance, wavelengths.density));
  return add_batch(*state_,
                   {at.x.data(), at.y.data(), data_or_null(at.weight), rows_of(radiance),
                    rows_of(wavelengths.lambda_nm), rows_of(wavelengths.density)},
                   at.x.size(), execution);
}

Result<void> Film::add(const SamplePositions& at, SampledSpectraView radiance, const Execution& execution) {
  SPECTILE_TRY(takes(*state_, FilmInput::kBands));
  SPECTILE_TRY(positions_fit(at, radiance.lanes));
  SPECTILE_TRY(shape::same_bands("the film", state_->options.bands, radiance.axis));
  return add_batch(
      *state_,
      {at.x.data(), at.y.data(), data_or_null(at.weight), rows_of(radiance), PieceRows(), PieceRows()},
      at.x.size(), execution);
}

}  // namespace spectile
