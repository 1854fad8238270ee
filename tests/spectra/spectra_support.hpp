// Shared by the tests of spectra.
#pragma once

namespace spectile::test {

/// A midpoint sum: slow, and nothing like what the library does.
template <class Function>
double riemann(const Function& f, double first, double last, int steps = 400000) {
  double sum = 0;
  const double step = (last - first) / steps;
  for (int i = 0; i < steps; ++i) sum += f(first + (i + 0.5) * step);
  return sum * step;
}

}  // namespace spectile::test
