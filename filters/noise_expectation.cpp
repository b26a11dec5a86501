// One iteration of expectation-maximisation [shumway1982]. With means over the samples, and expectations
// given the whole record, from the smoother:
//
//     s_R^2 = mean E[(y_i - h_i(z))^2] / R0_ii,  s_Q^2 = mean E[w_i^2] / Q0_ii,  s_P^2 = E[|P0^-1/2 (z_0 -
//     m_0)|^2] / r
#include <Eigen/QR>
#include <cmath>

#include "filters/covariance_factor.hpp"
#include "filters/noise_estimation.hpp"
#include "filters/smoother.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

// A mean of squares for each of several entries.
struct MeanSquares {
  explicit MeanSquares(Index size) : sums(VectorXd::Zero(size)), counts(VectorXd::Zero(size)) {}
  void add(Index i, double square) {
    sums[i] += square;
    counts[i] += 1.0;
  }
  // log of the root of the mean over a group; unchanged where nothing was counted
  double level(const std::vector<Index>& group, double unchanged) const {
    const double count = counts(group).sum();
    return count > 0.0 ? 0.5 * std::log(sums(group).sum() / count) : unchanged;
  }

  VectorXd sums, counts;
};

MeanSquares output_squares(const SmoothedRun& smoothed, ObservedModel& model, const Measurements& record,
                           const MatrixXd& guess) {
  MeanSquares result(record.outputs.rows());
  VectorXd expected, input;
  MatrixXd sensor;
  model.observe_all();
  for (Index k = 0; k < record.size(); ++k) {
    const Gaussian& estimate = smoothed.estimates[static_cast<std::size_t>(k)];
    if (record.inputs.size() > 0) input = record.inputs.col(k);
    model.output(estimate.mean, input, expected);
    model.output_jacobian(estimate.mean, input, sensor);
    const MatrixXd cross = estimate.factor.size() > 0
                               ? MatrixXd(estimate.factor * (sensor * estimate.factor).transpose())
                               : MatrixXd(estimate.covariance * sensor.transpose());
    for (Index i = 0; i < record.outputs.rows(); ++i) {
      if (std::isnan(record.outputs(i, k))) continue;
      const double variance =
          record.output_deviations.size() > 0 ? std::pow(record.output_deviations(i, k), 2) : guess(i, i);
      result.add(
          i, (std::pow(record.outputs(i, k) - expected[i], 2) + sensor.row(i).dot(cross.col(i))) / variance);
    }
  }
  return result;
}

// @param growth of Q over each interval: its length by that of the model.
MeanSquares process_squares(const SmoothedRun& smoothed, const VectorXd& growth, const MatrixXd& guess) {
  MeanSquares result(guess.rows());
  for (std::size_t k = 0; k < smoothed.noises.size(); ++k) {
    const VectorXd square = smoothed.noises[k].mean.cwiseAbs2() + smoothed.noises[k].deviations().cwiseAbs2();
    for (Index i = 0; i < guess.rows(); ++i)
      if (guess(i, i) > 0.0) result.add(i, square[i] / (guess(i, i) * growth[static_cast<Index>(k)]));
  }
  return result;
}

double initial_level(const Gaussian& first, const Gaussian& guess) {
  const MatrixXd root = factor_of(guess);
  const VectorXd lengths = root.rowwise().norm();
  const VectorXd unit = (lengths.array() > 0.0).select(lengths.cwiseInverse(), 1.0);
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> inverse(unit.asDiagonal() * root);
  const MatrixXd spread = factor_of(first);
  const double square = inverse.solve(unit.asDiagonal() * (first.mean - guess.mean)).squaredNorm() +
                        inverse.solve(unit.asDiagonal() * spread).squaredNorm();
  return 0.5 * std::log(square / static_cast<double>(inverse.rank()));
}

VectorXd intervals(const Measurements& record, double regular) {
  SampleClock clock(regular, record.time_resolution);
  clock.start(record.time[0]);
  VectorXd result(record.size() - 1);
  for (Index k = 0; k < result.size(); ++k) result[k] = clock.advance(record.time[k + 1]);
  return result;
}

}  // namespace

VectorXd NoiseLevels::expectation_maximisation(const VectorXd& x, double& log_likelihood) {
  ++runs_;
  const std::unique_ptr<Filter> filter = make_filter_(noise(x));
  const Measurements record = measurements(x);
  const FilterRun filtered = run(*filter, initial(x), record, Keep::all_estimates);
  log_likelihood = filtered.log_likelihood;
  if (filtered.failure || !std::isfinite(log_likelihood)) return {};
  const bool noises = !settings_.process_groups.empty();
  const SmoothedRun smoothed = smooth(filtered, filter->model(), record, "rts", {},
                                      noises ? Smooth::states_and_noises : Smooth::states);
  VectorXd result = x;
  Index place = 0;
  const MeanSquares outputs =
      output_squares(smoothed, filter->model(), measurements_, settings_.guess.output);
  for (const auto& group : outputs_) {
    result[place] = outputs.level(group, x[place]);
    ++place;
  }
  if (noises) {
    const double regular = filter->model().interval();
    const MeanSquares process =
        process_squares(smoothed, intervals(record, regular) / regular, settings_.guess.process);
    for (const auto& group : settings_.process_groups) {
      result[place] = process.level(group, x[place]);
      ++place;
    }
  }
  if (settings_.initial_level) result[place] = initial_level(smoothed.estimates.front(), initial_);
  return result;
}

}  // namespace beamid::filters
