// Real shapes of modes that were measured with phases.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

/// The real shape (p) nearest to a complex one: turned so that sum (Re)^2 is largest.
Eigen::VectorXd nearest_real(const Eigen::VectorXcd& shape);

}  // namespace beamid::experiments
