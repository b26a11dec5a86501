#include "experiments/identify/backbone/force_inversion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

struct WeightedFit {
  VectorXd value;
  MatrixXd covariance;  // by the deviations given
  double chi_square = 0;
};

WeightedFit weighted_fit(const MatrixXd& rows, const VectorXd& values, const VectorXd& deviations) {
  const VectorXd weight = deviations.cwiseInverse();
  const MatrixXd a = weight.asDiagonal() * rows;
  const VectorXd b = weight.cwiseProduct(values), scale = a.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const MatrixXd scaled = a * scale.asDiagonal();
  const MatrixXd inverse = (scaled.transpose() * scaled).ldlt().solve(MatrixXd::Identity(a.cols(), a.cols()));
  WeightedFit fit;
  fit.value = scale.asDiagonal() * inverse * (scaled.transpose() * b);
  fit.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  fit.chi_square = (b - a * fit.value).squaredNorm();
  return fit;
}

VectorXd reading_row(const SecantCurve& curve, double amplitude, WindowReading reading) {
  return reading == WindowReading::secant   ? curve.shape(amplitude)
         : reading == WindowReading::masing ? masing_stiffness(curve, amplitude)
                                            : elastic_stiffness(curve, amplitude);
}

template <typename Value>
VectorXd window_mean(const AmplitudeWindow& window, const Value& value) {
  VectorXd sum = window.weights[0] * value(window.nodes[0]);
  for (Index j = 1; j < window.nodes.size(); ++j) sum += window.weights[j] * value(window.nodes[j]);
  return sum;
}

ForceLaw fitted_curve(const std::vector<AmplitudeWindow>& windows, double range, WindowReading reading,
                      const VectorXd& stiffness, const VectorXd& deviation, Index least_terms) {
  const auto count = static_cast<Index>(windows.size());
  ForceLaw best;
  double least = std::numeric_limits<double>::infinity();
  for (const Index terms : {1, 2, 3, 4, 5, 6, 8}) {
    if (terms > least_terms && 2 * terms > count) break;
    if (terms < least_terms) continue;
    const SecantCurve curve(range, terms);
    MatrixXd rows(count, terms);
    for (Index i = 0; i < count; ++i)
      rows.row(i) = window_mean(windows[static_cast<std::size_t>(i)], [&](double a) {
                      return reading_row(curve, a, reading);
                    }).transpose();
    const WeightedFit fit = weighted_fit(rows, stiffness, deviation);
    const double bic = fit.chi_square + static_cast<double>(terms) * std::log(static_cast<double>(count));
    if (!fit.value.allFinite() || !(bic < least)) continue;
    least = bic;
    const double freedom = static_cast<double>(count - terms);
    const double excess = freedom > 0 ? std::max(1.0, fit.chi_square / freedom) : 1.0;
    best = {curve, fit.value, excess * fit.covariance, fit.chi_square, freedom};
  }
  return best;
}

}  // namespace

double ForceLaw::secant_deviation(double x) const {
  const VectorXd row = curve.shape(x);
  return std::sqrt(std::max(0.0, row.dot(covariance * row)));
}

double amplitude_of_harmonic(const ForceLaw& law, double first_harmonic) {
  double amplitude = first_harmonic;
  for (int round = 0; round < 2; ++round) {
    const double ratio = periodic_motion(law.curve, law.coefficients, amplitude).first_harmonic;
    if (!(ratio > 0.5 && ratio < 2)) return first_harmonic;
    amplitude = first_harmonic / ratio;
  }
  return amplitude;
}

ForceLaw invert_windows(const std::vector<AmplitudeWindow>& windows, double range, WindowReading reading,
                        Index least_terms) {
  const auto count = static_cast<Index>(windows.size());
  VectorXd stiffness(count), deviation(count);
  for (Index i = 0; i < count; ++i) stiffness[i] = windows[static_cast<std::size_t>(i)].stiffness;
  // what a window's mean neglects of the motion within it: nothing where the stiffness does not change
  const double neglected = 0.003 * std::min(1.0, stiffness.maxCoeff() / stiffness.minCoeff() - 1);
  for (Index i = 0; i < count; ++i)
    deviation[i] = std::hypot(windows[static_cast<std::size_t>(i)].stiffness_deviation,
                              std::max(neglected, 1e-9) * stiffness[i]);
  ForceLaw law = fitted_curve(windows, range, reading, stiffness, deviation, least_terms);
  if (reading != WindowReading::elastic) return law;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    VectorXd corrected = stiffness;
    for (Index i = 0; i < count; ++i) {
      const AmplitudeWindow& window = windows[static_cast<std::size_t>(i)];
      double first_harmonic = 0, exact = 0;
      for (Index j = 0; j < window.nodes.size(); ++j) {
        const double a = window.nodes[j];
        first_harmonic += window.weights[j] * elastic_stiffness(law.curve, a).dot(law.coefficients);
        exact += window.weights[j] *
                 periodic_motion(law.curve, law.coefficients, amplitude_of_harmonic(law, a)).stiffness;
      }
      if (exact > 0 && std::isfinite(exact)) corrected[i] *= first_harmonic / exact;
    }
    law = fitted_curve(windows, range, reading, corrected, deviation, least_terms);
  }
  return law;
}

}  // namespace beamid::experiments
