// A belief about a state, and the names of what is believed.
#pragma once

#include <Eigen/Core>
#include <string>

namespace beamid::filters {

/// Mean (n) and covariance (n x n).
struct Gaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Name and SI unit of a state or an output.
struct Label {
  std::string name;
  std::string unit;
};

}  // namespace beamid::filters
