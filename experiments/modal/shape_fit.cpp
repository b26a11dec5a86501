#include "experiments/modal/shape_fit.hpp"

#include <algorithm>

#include "experiments/signal/least_squares.hpp"

namespace beamid::experiments {

using Complex = std::complex<double>;
using Eigen::Index;

ShapeFit fit_shapes_at(const Eigen::MatrixXd& outputs, const Eigen::VectorXd& time,
                       const std::vector<Complex>& rates, const std::vector<bool>& oscillating) {
  const Index count = outputs.cols(), modes = static_cast<Index>(rates.size());
  const auto scaled_at = [&](Index m) { return rates[m].real() > 0 ? time[count - 1] : 0.0; };
  Eigen::MatrixXd basis(count, 2 * modes);
  Index columns = 0;
  for (Index m = 0; m < modes; ++m) {
    for (Index k = 0; k < count; ++k) {
      const Complex value = std::exp(rates[m] * (time[k] - scaled_at(m)));
      basis(k, columns) = value.real();
      if (oscillating[m]) basis(k, columns + 1) = -value.imag();
    }
    columns += oscillating[m] ? 2 : 1;
  }
  basis.conservativeResize(Eigen::NoChange, columns);
  const Eigen::MatrixXd parts = least_squares(basis, outputs.transpose());  // (columns x p)

  ShapeFit fit;
  fit.shapes.resize(outputs.rows(), modes);
  for (Index m = 0, at = 0; m < modes; ++m) {
    Eigen::VectorXcd shape = parts.row(at++).transpose().cast<Complex>();
    if (oscillating[m]) shape += Complex(0, 1) * parts.row(at++).transpose().cast<Complex>();
    fit.shapes.col(m) = shape * std::exp(-rates[m] * scaled_at(m));
  }
  fit.reconstruction = (basis * parts).transpose();
  const auto freedom = static_cast<double>(std::max<Index>(1, count - 2 * columns));
  fit.residual_standard_deviation =
      ((outputs - fit.reconstruction).rowwise().squaredNorm() / freedom).cwiseSqrt();
  return fit;
}

ShapeFit fit_shapes(const Eigen::MatrixXd& outputs, double interval, const std::vector<Complex>& rates,
                    const std::vector<bool>& oscillating) {
  Eigen::VectorXd time(outputs.cols());
  for (Index k = 0; k < time.size(); ++k) time[k] = interval * static_cast<double>(k);
  return fit_shapes_at(outputs, time, rates, oscillating);
}

}  // namespace beamid::experiments
