// This machine's own limits: how fast memory can be copied and filled, with nothing else to do.
#pragma once

#include <cstddef>

namespace machine {

/// Copies n floats with the widest loads and stores there are, unrolled. Both 64-byte aligned, n a multiple
/// of 128.
void copy(float* dst, const float* src, std::size_t n);
/// Fills n floats with stores that go round the caches.
void stream_fill(float* dst, float value, std::size_t n);
/// Fills n floats with ordinary stores.
void fill(float* dst, float value, std::size_t n);

/// n fused multiply-adds on floats, as many at a time as the compiler can; returns a sum of them.
float multiply_adds(std::size_t n);

}  // namespace machine
