// What the verification tests share: roots of frequency equations, and the comparison of both methods with
// them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "fem/assembly.hpp"
#include "fem/exact/exact_modes.hpp"
#include "fem/modes.hpp"

namespace beamid::test {

/// A uniform Euler-Bernoulli beam; numbers that no unit hides.
fem::Beam uniform_beam(std::vector<fem::Support> supports = {});
inline constexpr double length = 1.3, bending_stiffness = 7.3, mass_per_length = 0.9;

/// omega of b = beta L of that beam.
double angular_frequency(double b);

/// The first `count` positive roots, found in steps far below their spacing and bracketed to the last digit.
template <class Function>
std::vector<double> roots(const Function& f, int count, double step = 0.01, double start = 1e-3) {
  std::vector<double> found;
  double left = start, at_left = f(left);
  while (static_cast<int>(found.size()) < count) {
    const double right = left + step, at_right = f(right);
    if (at_left * at_right <= 0.0) {
      std::uintmax_t iterations = 200;
      const auto [a, b] = boost::math::tools::toms748_solve(
          f, left, right, at_left, at_right, boost::math::tools::eps_tolerance<double>(52), iterations);
      found.push_back(0.5 * (a + b));
    }
    left = right;
    at_left = at_right;
  }
  return found;
}

struct Tolerance {
  double finite_elements = 1e-7;
  double exact = 1e-12;
  int elements = 200;
};

/// Writes the largest error of the running test into the test report, from which docs/verification.md is
/// made.
void record(const std::string& key, double error);

/// Both methods against known frequencies [rad/s], zeros of rigid-body modes included.
void expect_frequencies(const fem::Beam& beam, const std::vector<double>& known,
                        const Tolerance& tolerance = {});

}  // namespace beamid::test
