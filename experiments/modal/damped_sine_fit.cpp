#include "experiments/modal/damped_sine_fit.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "filters/levenberg_marquardt.hpp"

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

/// Amplitudes and offset that are best for the given rates: a linear problem. At zero amplitude the rates
/// have no influence; a unit on their diagonal keeps them where they are.
VectorXd with_best_amplitudes(const VectorXd& signal, double interval, const std::vector<Complex>& rates) {
  VectorXd parameters = VectorXd::Zero(4 * static_cast<Index>(rates.size()) + 1);
  for (Index i = 0; i + 1 < parameters.size(); i += 4)
    parameters.segment<2>(i) << rates[i / 4].imag(), -rates[i / 4].real();
  SineLinearisation at = linearise(signal, interval, parameters);
  for (Index i = 0; i + 1 < parameters.size(); i += 4) at.normal.diagonal().segment<2>(i).setOnes();
  return parameters + filters::solve_damped(at.normal, 0, at.gradient);
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

DampedSineFit result_of(const VectorXd& parameters, const SineLinearisation& at, Index count) {
  const Index size = parameters.size();
  DampedSineFit fit;
  for (Index i = 0; i + 1 < size; i += 4)
    fit.sines.push_back({{-parameters[i + 1], parameters[i]}, {parameters[i + 2], parameters[i + 3]}});
  fit.offset = parameters[size - 1];
  fit.cofactors = filters::solve_damped(at.normal, 0, MatrixXd::Identity(size, size));
  fit.residuals = at.residuals;
  fit.residual_standard_deviation = std::sqrt(at.residuals.squaredNorm() / static_cast<double>(count - size));
  return fit;
}

}  // namespace

DampedSineFit fit_damped_sines(const VectorXd& signal, double interval, const std::vector<Complex>& start) {
  check_damped_sine_fit(signal, start);
  constexpr double tolerance = 1e-11;  // change of the model, relative to the signal
  const double smallest_change =
      tolerance * tolerance * signal.array().isFinite().select(signal, 0.0).squaredNorm();
  VectorXd parameters = with_best_amplitudes(signal, interval, start);
  SineLinearisation at = linearise(signal, interval, parameters);
  const auto step = [&](double damping) -> VectorXd {
    return filters::solve_damped(at.normal, damping, at.gradient);
  };
  const auto take = [&](const VectorXd& tried) {
    const bool settled = tried.dot(at.normal * tried) <= smallest_change;
    SineLinearisation next = linearise(signal, interval, parameters + tried);
    const bool lower = next.residuals.squaredNorm() <= at.residuals.squaredNorm();
    if (lower) parameters += tried, at = std::move(next);
    return filters::TriedStep{lower ? 1.0 : 0.0, settled};
  };
  const filters::MarquardtDamping rule;
  if (filters::levenberg_marquardt(rule, step, take) != filters::DescentEnd::exhausted)
    return result_of(parameters, at, measured(signal));
  std::ostringstream message;
  message << "the fit of " << start.size() << " damped sines has not converged after " << rule.most_steps
          << " iterations; the first stands at " << parameters[0] << " rad/s with damping rate "
          << parameters[1] << " 1/s";
  throw std::runtime_error(message.str());
}

}  // namespace beamid::experiments
