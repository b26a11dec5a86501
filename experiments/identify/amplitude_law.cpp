#include "experiments/identify/amplitude_law.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index law_unknowns = 7;  // w0, d0, w1, d1, Re and Im amplitude, offset
using Parameters = Eigen::Matrix<double, law_unknowns, 1>;
using Normal = Eigen::Matrix<double, law_unknowns, law_unknowns>;

/// log |z| a time later: the midpoint rule.
double decayed(const AmplitudeShape& shape, const Parameters& p, double log_amplitude, double time) {
  const double half = log_amplitude - 0.5 * time * (p[1] + p[3] * shape.at(log_amplitude));
  return log_amplitude - time * (p[1] + p[3] * shape.at(half));
}

struct LawStep {
  Normal normal = Normal::Zero();
  Parameters gradient = Parameters::Zero();
  double squares = 0;
};

/// At the parameters, with the amplitude that these make.
LawStep law_step(const VectorXd& signal, double interval, const AmplitudeShape& shape, const Parameters& p,
                 double log_amplitude) {
  LawStep at;
  double integral = 0, g = shape.at(log_amplitude);  // of g over time
  for (Index k = 0; k < signal.size(); ++k) {
    const double time = interval * static_cast<double>(k);
    const Complex unit = std::exp(Complex(-p[1], p[0]) * time + Complex(-p[3], p[2]) * integral),
                  value = Complex(p[4], p[5]) * unit;
    Parameters row;
    row << -time * value.imag(), -time * value.real(), -integral * value.imag(), -integral * value.real(),
        unit.real(), -unit.imag(), 1;
    const double residual = signal[k] - value.real() - p[6];
    at.normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    at.gradient += residual * row;
    at.squares += residual * residual;
    log_amplitude = decayed(shape, p, log_amplitude, interval);
    const double next = shape.at(log_amplitude);
    integral += 0.5 * interval * (g + next);
    g = next;
  }
  at.normal.triangularView<Eigen::StrictlyUpper>() = at.normal.transpose();
  return at;
}

/// Amplitude and offset best for these rates.
void fit_amplitude(const VectorXd& signal, double interval, const AmplitudeShape& shape, double log_amplitude,
                   Parameters& p) {
  const LawStep at = law_step(signal, interval, shape, p, log_amplitude);
  p.tail<3>() += at.normal.bottomRightCorner<3, 3>().ldlt().solve(at.gradient.tail<3>());
}

LawLine law_line(double constant, double slope, double variance, double covariance, double unit) {
  const double pivot = -covariance / variance;
  return {(constant + slope * pivot) / unit, slope / unit, pivot, std::sqrt(variance) / unit};
}

VectorXd shape_at(const VectorXd& instants, double interval, const AmplitudeShape& shape, const Parameters& p,
                  double log_amplitude) {
  VectorXd values(instants.size());
  double time = 0;
  for (Index i = 0; i < instants.size(); ++i) {
    const int steps = 1 + static_cast<int>(std::abs(instants[i] - time) / interval);
    for (int k = 0; k < steps; ++k)
      log_amplitude = decayed(shape, p, log_amplitude, (instants[i] - time) / steps);
    time = instants[i];
    values[i] = shape.at(log_amplitude);
  }
  return values;
}

}  // namespace

double AmplitudeShape::at(double log_amplitude) const {
  return power == 0 ? log_amplitude - log_reference : std::exp(power * (log_amplitude - log_reference));
}

AmplitudeLaw fit_amplitude_law(const VectorXd& signal, double interval, const AmplitudeShape& shape,
                               const AmplitudeLawStart& start, const VectorXd& instants) {
  constexpr double settled = 1e-8, twice_pi = 2 * std::numbers::pi;
  const double w = twice_pi * start.frequency_hz;
  Parameters p;
  p << w, start.damping_ratio * w, twice_pi * start.frequency_slope, start.damping_slope * w, 0, 0, 0;
  double log_amplitude = start.log_amplitude;
  fit_amplitude(signal, interval, shape, log_amplitude, p);
  LawStep at = law_step(signal, interval, shape, p, log_amplitude);
  const auto step = [&](double damping) -> VectorXd {
    return filters::solve_damped(at.normal, damping, at.gradient);
  };
  const auto take = [&](const VectorXd& tried) {  // always: the amplitude is that of the step before
    p += tried;
    log_amplitude = std::log(std::hypot(p[4], p[5]));
    const double before = at.squares;
    at = law_step(signal, interval, shape, p, log_amplitude);
    return filters::TriedStep{1.0, std::abs(before - at.squares) <= settled * at.squares};
  };
  filters::MarquardtDamping rule;
  rule.most_steps = 30;
  if (filters::levenberg_marquardt(rule, step, take) != filters::DescentEnd::settled)
    throw std::runtime_error("the fit of a decay that follows its amplitude has not converged");
  AmplitudeLaw law;
  law.squares = at.squares;
  law.freedom = static_cast<double>(signal.size() - law_unknowns);
  const Normal covariance =
      at.squares / law.freedom * Normal(filters::solve_damped(at.normal, 0, Normal::Identity()));
  law.frequency_hz = law_line(p[0], p[2], covariance(2, 2), covariance(0, 2), twice_pi);
  const double omega = twice_pi * law.frequency_hz.value;
  law.damping_ratio = law_line(p[1], p[3], covariance(3, 3), covariance(1, 3), omega);
  law.frequency_hz.value *= std::hypot(1.0, law.damping_ratio.value);  // |s| of its imaginary part
  law.shape = shape_at(instants, interval, shape, p, log_amplitude);
  if (!law.shape.allFinite() || !(law.frequency_hz.slope_deviation > 0) ||
      !(law.damping_ratio.slope_deviation > 0))
    throw std::runtime_error("the fit of a decay that follows its amplitude determines nothing");
  return law;
}

}  // namespace beamid::experiments
