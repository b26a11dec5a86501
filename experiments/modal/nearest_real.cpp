#include "experiments/modal/nearest_real.hpp"

#include <complex>

namespace beamid::experiments {

Eigen::VectorXd nearest_real(const Eigen::VectorXcd& shape) {
  const std::complex<double> square = shape.cwiseProduct(shape).sum();
  return (shape * std::polar(1.0, -0.5 * std::arg(square))).real();
}

}  // namespace beamid::experiments
