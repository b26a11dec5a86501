// Small tools of signal analysis: seeded noise, quantiles, lengths that transform fast, least squares,
// medians.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "filters/random.hpp"

namespace beamid::experiments {

// Points of chi-square and of Student's t.

/// 95 % point of chi-square, or another one. @param freedom above 0
double chi_square_limit(double freedom, double probability = 0.95);

/// 97.5 % point of Student's t over that of the normal distribution: what not knowing a noise exactly adds to
/// a 95 % interval.
double student_factor(double freedom);

// A check that settings of studies share.

/// @throws std::invalid_argument "mass: -1.000000; expected a positive number"
void require_positive(double value, const std::string& name);

// Lengths that transform fast: no prime factor above 7, or another that is asked for.

bool transforms_fast(Eigen::Index length, Eigen::Index largest_factor = 7);
/// The longest of at most so many samples (1 or more).
Eigen::Index fast_length_within(Eigen::Index samples, Eigen::Index largest_factor = 7);
/// The shortest even one that holds so many samples.
Eigen::Index even_fast_length_around(Eigen::Index samples);

// Linear least squares that refuse what is not finite.

/// x (n x q) of min |A x - b|, by QR with column pivoting, the columns of A scaled to one: their units
/// differ. What A (m x n) leaves undetermined is zero; without columns x has no rows.
/// @throws std::invalid_argument when A or b holds a value that is not a finite number: no pivot means
/// anything then, and Eigen checks nothing in a release build.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXcd complex_least_squares(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b);

// The middle of several values, which outliers do not move.

/// The upper one of the two middle values where there are two. @param values at least one
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

inline double median(const Eigen::VectorXd& values) {
  return median(std::vector<double>(values.begin(), values.end()));
}

/// `count` independent standard normal numbers.
/// @param seed of the study, @param stream of the case within it: different streams are independent.
inline Eigen::VectorXd standard_normal(Eigen::Index count, std::uint64_t seed, std::uint64_t stream) {
  return filters::RandomStream(seed, stream).normal(count, 1);
}

}  // namespace beamid::experiments
