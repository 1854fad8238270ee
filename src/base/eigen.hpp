// Eigen, which leaves pointers to freed memory behind where an allocation fails.
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <list>
#include <map>
#include <new>
#include <sstream>
#include <string>
#include <vector>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace spectile {

[[noreturn]] inline void throw_bad_alloc() {
  throw std::bad_alloc();
}

/// std::malloc(), but the end of the process (std::terminate) where there is no memory: Eigen 3.4 frees a
/// matrix before it takes memory for its new size, and frees it again when the exception passes.
inline void* malloc_or_end(std::size_t bytes) noexcept {
  void* const memory = std::malloc(std::max<std::size_t>(bytes, 1));
  if (memory == nullptr) throw_bad_alloc();
  return memory;
}

}  // namespace spectile

// Eigen takes no allocator.
namespace std {  // NOLINT(cert-dcl58-cpp)
using spectile::malloc_or_end;
}
#define malloc malloc_or_end
#include <Eigen/Dense>
#include <Eigen/Sparse>
#undef malloc
