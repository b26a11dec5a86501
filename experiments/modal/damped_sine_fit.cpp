#include "experiments/modal/damped_sine_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Parameters w, d (damping rate), a, b of each sine e^(-d t) (a cos w t - b sin w t), then the offset.
struct SineLinearisation {
  MatrixXd normal;     ///< J^T J
  VectorXd gradient;   ///< J^T r
  VectorXd residuals;  ///< r = y - model
};

SineLinearisation linearise(const VectorXd& signal, double interval, const VectorXd& parameters) {
  const Index size = parameters.size();
  SineLinearisation at{MatrixXd::Zero(size, size), VectorXd::Zero(size), VectorXd(signal.size())};
  VectorXd row(size);
  row[size - 1] = 1;
  for (Index k = 0; k < signal.size(); ++k) {
    at.residuals[k] = 0;
    if (!std::isfinite(signal[k])) continue;
    const double time = interval * static_cast<double>(k);
    double model = parameters[size - 1];
    for (Index i = 0; i + 1 < size; i += 4) {
      const Complex unit = std::exp(Complex(-parameters[i + 1], parameters[i]) * time);
      const Complex value = Complex(parameters[i + 2], parameters[i + 3]) * unit;
      row.segment<4>(i) << -time * value.imag(), -time * value.real(), unit.real(), -unit.imag();
      model += value.real();
    }
    at.residuals[k] = signal[k] - model;
    at.normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    at.gradient += at.residuals[k] * row;
  }
  at.normal.triangularView<Eigen::StrictlyUpper>() = at.normal.transpose();
  return at;
}

/// (J^T J + damping diag(J^T J))^-1 b, with the columns scaled to one: their units differ.
MatrixXd solve_scaled(const MatrixXd& normal, double damping, const MatrixXd& right) {
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += damping;
  return scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * right);
}

/// Amplitudes and offset that are best for the given rates: a linear problem. At zero amplitude the rates
/// have no influence; a unit on their diagonal keeps them where they are.
VectorXd with_best_amplitudes(const VectorXd& signal, double interval, const std::vector<Complex>& rates) {
  VectorXd parameters = VectorXd::Zero(4 * static_cast<Index>(rates.size()) + 1);
  for (Index i = 0; i + 1 < parameters.size(); i += 4)
    parameters.segment<2>(i) << rates[i / 4].imag(), -rates[i / 4].real();
  SineLinearisation at = linearise(signal, interval, parameters);
  for (Index i = 0; i + 1 < parameters.size(); i += 4) at.normal.diagonal().segment<2>(i).setOnes();
  return parameters + solve_scaled(at.normal, 0, at.gradient);
}

Index measured(const VectorXd& signal) {
  return signal.array().isFinite().count();
}

void check_damped_sine_fit(const VectorXd& signal, const std::vector<Complex>& start) {
  const std::size_t fewest = 2 * (4 * start.size() + 1);
  const bool oscillating = std::all_of(start.begin(), start.end(), [](Complex rate) {
    return rate.imag() > 0 && std::isfinite(rate.imag()) && std::isfinite(rate.real());
  });
  if (!start.empty() && oscillating && static_cast<std::size_t>(measured(signal)) >= fewest) return;
  std::ostringstream message;
  message << "fit of " << start.size() << " damped sines to " << measured(signal) << " samples";
  for (const Complex& rate : start) message << ", from " << rate.real() << " + " << rate.imag() << "i rad/s";
  message << "; expected at least " << fewest << " samples and one or more positive angular frequencies";
  throw std::invalid_argument(message.str());
}

DampedSineFit result_of(const VectorXd& parameters, const SineLinearisation& at, Index count,
                        int iterations) {
  const Index size = parameters.size();
  DampedSineFit fit;
  for (Index i = 0; i + 1 < size; i += 4)
    fit.sines.push_back({{-parameters[i + 1], parameters[i]}, {parameters[i + 2], parameters[i + 3]}});
  fit.offset = parameters[size - 1];
  fit.cofactors = solve_scaled(at.normal, 0, MatrixXd::Identity(size, size));
  fit.residuals = at.residuals;
  fit.residual_standard_deviation = std::sqrt(at.residuals.squaredNorm() / static_cast<double>(count - size));
  fit.iterations = iterations;
  return fit;
}

}  // namespace

DampedSineFit fit_damped_sines(const VectorXd& signal, double interval, const std::vector<Complex>& start) {
  check_damped_sine_fit(signal, start);
  constexpr int most_iterations = 100;
  constexpr double tolerance = 1e-11;  // change of the model, relative to the signal
  const double smallest_change =
      tolerance * tolerance * signal.array().isFinite().select(signal, 0.0).squaredNorm();
  VectorXd parameters = with_best_amplitudes(signal, interval, start);
  SineLinearisation at = linearise(signal, interval, parameters);
  double damping = 0;
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    const VectorXd step = solve_scaled(at.normal, damping, at.gradient);
    const bool converged = step.dot(at.normal * step) <= smallest_change;
    const SineLinearisation next = linearise(signal, interval, parameters + step);
    if (next.residuals.squaredNorm() <= at.residuals.squaredNorm()) {
      parameters += step;
      at = next;
      damping = damping > 1e-6 ? 0.1 * damping : 0;
    } else {
      damping = std::max(1e-3, 10 * damping);
    }
    if (converged) return result_of(parameters, at, measured(signal), iteration);
  }
  std::ostringstream message;
  message << "the fit of " << start.size() << " damped sines has not converged after " << most_iterations
          << " iterations; the first stands at " << parameters[0] << " rad/s with damping rate "
          << parameters[1] << " 1/s";
  throw std::runtime_error(message.str());
}

}  // namespace beamid::experiments
