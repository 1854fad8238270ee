// The search for the sigmoid that has a colour: an expansion around the nearest node, then Newton's method.
#pragma once

#include "kernels/upsampling/sigmoid_newton.inl"

namespace spectile::kernels {
namespace {

/// Colours that are searched for, and under which conditions.
struct Search {
  F32 target[3];
  F32 close;  // what the residual times the step may be at the end
  F32 steep;  // longest coefficients allowed
  F32 scale;  // power of four that brightens the first colour searched for
  F32 steps;  // evaluations at most
};

/// Steps from coefficients for the brightened colours to those of the targets. A lane that is done stays as
/// it is, so that no lane depends on its neighbours.
template <class Form>
inline void refine(Coefficients& a, const Search& search, const SigmoidTable& table) noexcept {
  const F32 zero(0.0F);
  const F32 one(1.0F);
  F32 scale = search.scale;
  F32 goal[3];
  for (std::size_t k = 0; k < 3; ++k) goal[k] = search.target[k] * scale;
  SigmoidSums sums = band_sums<Form>(a, table);
  Residual left = residual(sums, goal);
  F32 part = one;
  Mask active = scale == scale;
  for (int i = 0; i < kSigmoidSteps; ++i) {
    active = active & (F32(static_cast<float>(i)) < search.steps);
    if (lane_bits(active) == 0) break;
    const Coefficients step = newton_step(sums, left);
    const Mask rounded = left.size <= F32(kSigmoidFloor);
    const Mask arrived = rounded | is_last(left, step, search.close);
    const F32 length = xsimd::select(rounded, zero, xsimd::select(arrived, one, part));
    Coefficients trial;
    for (std::size_t k = 0; k < 3; ++k) trial.c[k] = a.c[k] + length * step.c[k];
    const Mask done = active & arrived & (scale == one);
    for (std::size_t k = 0; k < 3; ++k) a.c[k] = xsimd::select(done, trial.c[k], a.c[k]);
    active = active & ~done;
    if (lane_bits(active) == 0) break;
    const Mask down = active & arrived;
    scale = xsimd::select(down, scale * F32(0.25F), scale);
    for (std::size_t k = 0; k < 3; ++k) {
      trial.c[k] = xsimd::select(down, trial.c[k] + trial.c[k], trial.c[k]);
      goal[k] = xsimd::select(down, search.target[k] * scale, goal[k]);
    }
    const SigmoidSums sums_there = band_sums<Form>(trial, table);
    const Residual left_there = residual(sums_there, goal);
    const Mask better =
        down | (active & (left_there.size < left.size) & (magnitude_sum(trial) <= search.steep));
    for (std::size_t k = 0; k < 3; ++k) {
      a.c[k] = xsimd::select(better, trial.c[k], a.c[k]);
      left.r[k] = xsimd::select(better, left_there.r[k], left.r[k]);
    }
    for (std::size_t k = 0; k < 9; ++k) sums.j[k] = xsimd::select(better, sums_there.j[k], sums.j[k]);
    left.size = xsimd::select(better, left_there.size, left.size);
    const F32 doubled = part + part;
    const F32 longer = xsimd::select(down | (doubled > one), one, doubled);
    part = xsimd::select(better, longer, part * F32(0.25F));
    active = active & (better | (part >= F32(kSigmoidShortest)));
  }
  const F32 root = square_root(scale);
  for (auto& v : a.c) v = v * root;
}

/// How much too large the residual of coefficients is for colours of which z is the largest component.
template <class Form>
inline F32 excess(const Coefficients& a, const F32 target[3], F32 z, const SigmoidTable& table) noexcept {
  const Residual left = residual(band_sums<Form>(a, table), target);
  return left.size - max(F32(kSigmoidRounding), min(F32(kSigmoidUnsolved), z * F32(kSigmoidMet)));
}

// Lanes solved together, so that those which need more steps can be gathered from among them.
inline constexpr std::size_t kSigmoidBatch = 512;

/// Lanes that the first step leaves for those after it.
struct SigmoidBatch {
  alignas(64) float c[3][kSigmoidBatch];
  alignas(64) float target[3][kSigmoidBatch];
  alignas(64) float close[kSigmoidBatch];
  /// largest component that the start had; minus that outside the cube
  alignas(64) float inside[kSigmoidBatch];
  alignas(64) float excess[kSigmoidBatch];
  alignas(64) std::uint16_t lane[kSigmoidBatch];
  std::size_t count = 0;
};

/// The first step of a vector of lanes; queues those that need more.
template <class Form>
inline Coefficients first_step(const F32 rgb[3], std::size_t lane, const SigmoidTable& table, Mask& bright,
                               Mask& finite, SigmoidBatch& batch) noexcept {
  const F32 zero(0.0F);
  const F32 one(1.0F);
  finite = (rgb[0] - rgb[0] == zero) & (rgb[1] - rgb[1] == zero) & (rgb[2] - rgb[2] == zero);
  F32 v[3];
  F32 target[3];
  Mask inside = finite;
  for (std::size_t k = 0; k < 3; ++k) {
    target[k] = xsimd::select(finite, rgb[k], zero);
    v[k] = min(one, max(zero, target[k]));
    inside = inside & (v[k] == target[k]);
  }
  const F32 high = max(max(v[0], v[1]), v[2]);
  const F32 low = min(min(v[0], v[1]), v[2]);
  // The reflectance of 1 - colour is 1 - reflectance: only the dark half of the cube is searched.
  bright = high + low > one;
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = xsimd::select(bright, one - v[k], v[k]);
    target[k] = xsimd::select(bright, one - target[k], target[k]);
  }
  const F32 z = max(max(v[0], v[1]), v[2]);
  const Mask black = z < F32(kSigmoidBlack);
  const Mask grey = (v[0] == v[1]) & (v[1] == v[2]);
  F32 lit[3];
  for (std::size_t k = 0; k < 3; ++k) lit[k] = xsimd::select(black, F32(0.5F), v[k]);
  const F32 lit_z = xsimd::select(black, F32(0.5F), z);
  Coefficients out = start(lit, lit_z, table);
  const SigmoidSums sums = band_sums<Form>(out, table);
  const Residual left = residual(sums, target);
  const Coefficients step = newton_step(sums, left);
  const Mask near = left.size <= F32(kSigmoidNear) * z;
  const F32 floor(kSigmoidDark);
  const F32 close = F32(kSigmoidClose) * xsimd::select(z < floor, floor, z);
  const Mask last = inside & near & is_last(left, step, close);
  for (std::size_t k = 0; k < 3; ++k) out.c[k] = xsimd::select(near, out.c[k] + step.c[k], out.c[k]);
  // Colours known without a search.
  const F32 level = divide(lit_z - F32(0.5F), square_root(lit_z * (one - lit_z)));
  const Mask flat = inside & (black | grey);
  const F32 known = xsimd::select(black, F32(-kSigmoidFar), level);
  out.c[0] = xsimd::select(flat, zero, out.c[0]);
  out.c[1] = xsimd::select(flat, zero, out.c[1]);
  out.c[2] = xsimd::select(flat, known, out.c[2]);
  std::uint64_t waiting = lane_bits(finite & ~flat & ~last);
  if (waiting != 0) {
    alignas(64) float values[8][kWidth];
    for (std::size_t k = 0; k < 3; ++k) {
      store(values[k], out.c[k]);
      store(values[3 + k], target[k]);
    }
    store(values[6], close);
    store(values[7], xsimd::select(inside, z, -lit_z));
    for (; waiting != 0; waiting &= waiting - 1) {
      const auto i = static_cast<std::size_t>(__builtin_ctzll(waiting));
      const std::size_t at = batch.count++;
      for (std::size_t k = 0; k < 3; ++k) {
        batch.c[k][at] = values[k][i];
        batch.target[k][at] = values[3 + k][i];
      }
      batch.close[at] = values[6][i];
      batch.inside[at] = values[7][i];
      batch.lane[at] = static_cast<std::uint16_t>(lane + i);
    }
  }
  return out;
}

/// The further steps of the lanes that wait.
template <class Form>
inline void refine_batch(SigmoidBatch& batch, const SigmoidTable& table) noexcept {
  // The last vector is filled up with copies of its first lane.
  for (std::size_t at = batch.count; at % kWidth != 0; ++at) {
    const std::size_t from = at / kWidth * kWidth;
    for (std::size_t k = 0; k < 3; ++k) {
      batch.c[k][at] = batch.c[k][from];
      batch.target[k][at] = batch.target[k][from];
    }
    batch.close[at] = batch.close[from];
    batch.inside[at] = batch.inside[from];
  }
  const F32 one(1.0F);
  for (std::size_t at = 0; at < batch.count; at += kWidth) {
    Coefficients a;
    Search search;
    for (std::size_t k = 0; k < 3; ++k) {
      a.c[k] = load(batch.c[k] + at);
      search.target[k] = load(batch.target[k] + at);
    }
    search.close = load(batch.close + at);
    const F32 signed_z = load(batch.inside + at);
    const Mask inside = signed_z >= F32(0.0F);
    const F32 z = xsimd::abs(signed_z);
    search.steep = xsimd::select(inside, F32(kSigmoidFar), divide(F32(kSigmoidSteep), square_root(z)));
    search.steps = xsimd::select(inside, F32(static_cast<float>(kSigmoidSteps)),
                                 F32(static_cast<float>(kSigmoidStepsOutside)));
    search.scale = one;
    for (int level = 0; level < kSigmoidLevels; ++level) {
      const Mask dark = inside & (z * search.scale < F32(kSigmoidLit));
      search.scale = xsimd::select(dark, search.scale * F32(4.0F), search.scale);
    }
    const Mask brightened = search.scale > one;
    if (lane_bits(brightened) != 0) {
      F32 lit[3];
      for (std::size_t k = 0; k < 3; ++k) {
        lit[k] = xsimd::select(brightened, search.target[k] * search.scale, F32(0.5F));
      }
      const Coefficients first = start(lit, max(max(lit[0], lit[1]), lit[2]), table);
      for (std::size_t k = 0; k < 3; ++k) a.c[k] = xsimd::select(brightened, first.c[k], a.c[k]);
    }
    refine<Form>(a, search, table);
    store(batch.excess + at, excess<Form>(a, search.target, z, table));
    for (std::size_t k = 0; k < 3; ++k) store(batch.c[k] + at, a.c[k]);
  }
}

template <class Form>
inline void solve(float* const c[3], const float* const rgb[3], const SigmoidTable& table,
                  std::uint64_t* unsolved, std::size_t n) noexcept {
  SigmoidBatch batch;
  for (std::size_t first = 0; first < n; first += kSigmoidBatch) {
    const std::size_t count = n - first < kSigmoidBatch ? n - first : kSigmoidBatch;
    std::uint64_t bright_lanes[kSigmoidBatch / 64] = {};
    batch.count = 0;
    for (std::size_t lane = 0; lane < count; lane += kWidth) {
      F32 in[3];
      for (std::size_t k = 0; k < 3; ++k) in[k] = load(rgb[k] + first + lane);
      Mask bright, finite;
      const Coefficients out = first_step<Form>(in, lane, table, bright, finite, batch);
      bright_lanes[lane / 64] |= lane_bits(bright) << (lane % 64);
      for (std::size_t k = 0; k < 3; ++k) {
        const F32 turned = xsimd::select(bright, out.c[k] * F32(-1.0F), out.c[k]);
        store(c[k] + first + lane, xsimd::select(finite, turned, F32(__builtin_nanf(""))));
      }
    }
    for (std::size_t block = 0; block < count / kLanes; ++block) unsolved[first / kLanes + block] = 0;
    if (batch.count == 0) continue;
    refine_batch<Form>(batch, table);
    for (std::size_t at = 0; at < batch.count; ++at) {
      const std::size_t lane = batch.lane[at];
      const bool turn = ((bright_lanes[lane / 64] >> (lane % 64)) & 1U) != 0;
      for (std::size_t k = 0; k < 3; ++k) c[k][first + lane] = turn ? -batch.c[k][at] : batch.c[k][at];
      if (!(batch.excess[at] <= 0.0F)) {
        unsolved[(first + lane) / kLanes] |= std::uint64_t{1} << (lane % kLanes);
      }
    }
  }
}

void sigmoid_solve(float* const c[3], const float* const rgb[3], const SigmoidTable& table,
                   std::uint64_t* unsolved, std::size_t n) noexcept {
  with_form(table.form, [&](auto form) { solve<decltype(form)>(c, rgb, table, unsolved, n); });
}

}  // namespace
}  // namespace spectile::kernels
