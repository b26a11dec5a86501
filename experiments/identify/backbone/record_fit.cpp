#include "experiments/identify/backbone/record_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/signal/decimation.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

filters::BatchSettings DecaySamples::batch_settings(int steps_between, bool grow, int most) const {
  constexpr double start_cycles = 3;  // from which the fit grows over the record
  filters::BatchSettings settings;
  settings.tolerance = 1e-2;
  settings.max_iterations = most;
  if (grow)
    settings.first_samples = static_cast<Index>(start_cycles / (frequency_hz * interval()) * steps_between);
  return settings;
}

DecaySamples decay_samples(const VectorXd& signal, double interval, Quantity quantity, double frequency_hz,
                           double samples_per_period) {
  constexpr double steps_per_period = 48;
  DecaySamples result;
  const int factor = decimation_factor(1 / (samples_per_period * frequency_hz * interval), signal.size());
  result.factor = factor >= 4 ? factor : 1;  // a low-pass costs the first samples, the largest
  const DecimatedSignal kept = decimate(signal, interval, result.factor);
  if (result.factor > 1) result.whiteness = result.factor * kept.kernel.squaredNorm();
  result.lost = kept.start;
  result.frequency_hz = frequency_hz;
  result.quantity = quantity;
  result.steps = std::max(1, static_cast<int>(std::ceil(steps_per_period * frequency_hz * kept.interval)));
  const Index count = kept.samples.size(), n = (count - 1) * result.steps + 1;
  result.plain.time = kept.interval * VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  result.plain.outputs = kept.samples.transpose();
  result.fine.time = kept.interval / result.steps * VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1));
  result.fine.outputs.setConstant(1, n, std::numeric_limits<double>::quiet_NaN());
  for (Index k = 0; k < count; ++k) result.fine.outputs(0, k * result.steps) = kept.samples[k];
  return result;
}

namespace {

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

RecordFit record_fit(const std::string& name, const filters::BatchEstimate& found,
                     const DecaySamples& samples, int steps) {
  RecordFit fit;
  fit.name = name;
  fit.reason = found.reason;
  fit.converged = found.status == filters::BatchStatus::converged;
  if (found.status == filters::BatchStatus::failed) return fit;
  fit.residuals.resize(samples.size());
  for (Eigen::Index k = 0; k < samples.size(); ++k) fit.residuals[k] = found.residuals(0, k * steps);
  fit.left = fit.residuals.norm() / samples.plain.outputs.norm();
  return fit;
}

namespace {

/// Where a fit begins, and the unit of each entry of the state.
struct ScaledState {
  VectorXd state, scale;
};

ScaledState scaled_start(const JointModel& model, const Oscillator& oscillator, const ModelStart& start,
                         const Eigen::Vector2d& motion, double offset) {
  ScaledState result;
  result.state = result.scale = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  VectorXd &state = result.state, &scale = result.scale;
  const double omega = oscillator.angular_frequency(),
               size = motion.norm() > 0 ? std::hypot(motion[0], motion[1] / omega) : 1;
  state.head<2>() = motion;
  scale.head<2>() << size, size * omega;
  for (const Index slip : model.slips) scale[slip] = size;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    for (const auto& [quantity, value] : start)
      if (model.unknowns[j].quantity == quantity) {
        state[model.unknown_places[j]] = model.unknowns[j].to_state(value);
        scale[model.unknown_places[j]] = std::max(std::abs(value), 1e-3 * model.unknowns[j].deviation);
      }
  for (const JointModel::Offset& one : model.offsets) {
    state[one.place] = offset;
    scale[one.place] = size * omega * omega;
  }
  return result;
}

RecordFit fit_from(const std::string& name, const JointModel& model, const DecaySamples& samples,
                   double noise, const ScaledState& start) {
  const auto discrete = filters::discretise(model.motion, samples.interval() / samples.steps, "runge_kutta_4",
                                            {{}, MatrixXd::Constant(1, 1, noise * noise)});
  const filters::BatchEstimate found =
      filters::estimate_batch(*discrete, start.state, start.scale.asDiagonal(), samples.fine,
                              samples.batch_settings(samples.steps, true, 12));
  RecordFit fit = record_fit(name, found, samples, samples.steps);
  fit.unknowns = start.state.size();
  return fit;
}

}  // namespace

RecordFit registered_fit(const std::string& name, const DecaySamples& samples, double mass, double noise,
                         const Eigen::Vector2d& motion, double offset,
                         const std::vector<ModelStart>& starts) {
  RecordFit best;
  best.name = name;
  for (const ModelStart& start : starts) {
    const Oscillator oscillator{mass, start[0].second, start[1].second};
    const auto model =
        model_registry().make(name, {}, at_one_point(one_coordinate(oscillator), {samples.quantity}));
    const ScaledState begin = scaled_start(*model, oscillator, start, motion, offset);
    try {
      RecordFit fit = fit_from(name, *model, samples, noise, begin);
      if (fit.residuals.size() == 0) {
        if (best.residuals.size() == 0) best.reason = fit.reason;
        continue;
      }
      if (best.residuals.size() == 0 || fit.left < best.left) best = std::move(fit);
    } catch (const std::exception& error) {
      if (best.residuals.size() == 0) best.reason = error.what();
    }
  }
  return best;
}

}  // namespace beamid::experiments
