// The middle of several values, which outliers do not move.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace beamid::experiments {

/// The upper one of the two middle values where there are two. @param values at least one
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

inline double median(const Eigen::VectorXd& values) {
  return median(std::vector<double>(values.begin(), values.end()));
}

}  // namespace beamid::experiments
