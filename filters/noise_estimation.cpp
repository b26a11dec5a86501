#include "filters/noise_estimation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "filters/covariance_factor.hpp"
#include "filters/smoother.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double difference = 3e-4;       // in log s: truncation 1e-8 of the curvature, rounding 1e-6 of it
constexpr double negligible_gain = 1e-9;  // of the log-likelihood
constexpr double rounding = 1e-13;        // of the log-likelihood, as a share: a gain below it cannot be seen
constexpr double longest = 1.5;           // step in log s

struct Quadratic {
  VectorXd slope;
  MatrixXd curvature;  // of minus the log-likelihood
};

// The log-likelihood about x to second order, by central differences.
Quadratic differences(NoiseLevels& levels, const VectorXd& x, double centre) {
  const Index q = x.size();
  Quadratic result{VectorXd(q), MatrixXd(q, q)};
  std::vector<VectorXd> places;  // above and below x in entry i, then in entries i and j together
  const auto add = [&](Index i, Index j) {
    for (const double side : {difference, -difference}) {
      places.push_back(x);
      places.back()[i] += side;
      if (j != i) places.back()[j] += side;
    }
  };
  for (Index i = 0; i < q; ++i)
    for (Index j = i; j >= 0; --j) add(i, j);
  const std::vector<double> values = levels.log_likelihoods(places);
  auto next = values.begin();
  VectorXd above(q), below(q);
  for (Index i = 0; i < q; ++i) {
    above[i] = *next++;
    below[i] = *next++;
    result.slope[i] = (above[i] - below[i]) / (2.0 * difference);
    result.curvature(i, i) = -(above[i] - 2.0 * centre + below[i]) / (difference * difference);
    for (Index j = i; j-- > 0;) {
      const double one = *next++, other = *next++, both = one + other;
      result.curvature(i, j) = result.curvature(j, i) =
          -(both - above[i] - below[i] - above[j] - below[j] + 2.0 * centre) /
          (2.0 * difference * difference);
    }
  }
  return result;
}

// Newton's step uphill, with the curvature's absolute eigenvalues; how much it should gain.
VectorXd newton_step(const Quadratic& local, double& gain) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(local.curvature);
  const VectorXd along = eigen.eigenvectors().transpose() * local.slope;
  const VectorXd curvature = eigen.eigenvalues().cwiseAbs().cwiseMax(1e-12);
  gain = 0.5 * along.cwiseAbs2().cwiseQuotient(curvature).sum();
  VectorXd step = eigen.eigenvectors() * along.cwiseQuotient(curvature);
  if (const double size = step.cwiseAbs().maxCoeff(); size > longest) step *= longest / size;
  return step;
}

VectorXd standard_errors(const MatrixXd& curvature) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(curvature);
  VectorXd result(curvature.rows());
  for (Index i = 0; i < result.size(); ++i) {
    double variance = 0.0;
    for (Index j = 0; j < result.size(); ++j) {
      const double share = std::pow(eigen.eigenvectors()(i, j), 2);
      if (share > 1e-12)
        variance += eigen.eigenvalues()[j] > 1e-6 ? share / eigen.eigenvalues()[j] : infinity;
    }
    result[i] = std::sqrt(variance);
  }
  return result;
}

// The highest of x + step, x + step/2, ... that lies above `before`; x itself where none does.
double climb(NoiseLevels& levels, VectorXd& x, const VectorXd& step, double before) {
  for (double share = 1.0; share > 1e-4; share *= 0.5) {
    const VectorXd trial = x + share * step;
    if (const double found = levels.log_likelihood(trial); found > before) {
      x = trial;
      return found;
    }
  }
  return before;
}

void ascend(NoiseLevels& levels, const NoiseSettings& settings, VectorXd& x, NoiseEstimate& result) {
  double value = levels.log_likelihood(x), gain = 0.0;
  result.log_likelihoods.push_back(value);
  for (int i = 0; i < settings.max_iterations && std::isfinite(value); ++i) {
    const Quadratic local = differences(levels, x, value);
    if (!local.slope.allFinite() || !local.curvature.allFinite()) break;
    const VectorXd step = newton_step(local, gain);
    const double unseen = std::max(negligible_gain, rounding * std::abs(value));
    if (step.cwiseAbs().maxCoeff() < settings.tolerance || gain < unseen) {
      result.status = NoiseStatus::converged;
      return;
    }
    const double before = value;
    value = climb(levels, x, step, before);
    result.log_likelihoods.push_back(value);
    if (value == before) {  // flat to rounding
      result.status = gain < 1e-6 ? NoiseStatus::converged : NoiseStatus::iterations_exhausted;
      return;
    }
  }
  result.status = std::isfinite(value) ? NoiseStatus::iterations_exhausted : NoiseStatus::failed;
}

void iterate(NoiseLevels& levels, const NoiseSettings& settings, VectorXd& x, NoiseEstimate& result) {
  for (int i = 0; i <= settings.max_iterations; ++i) {
    double value = 0.0;
    const VectorXd next = levels.expectation_maximisation(x, value);
    result.log_likelihoods.push_back(value);
    if (next.size() == 0 || !next.allFinite()) return;  // failed
    const double gain = i > 0 ? value - result.log_likelihoods[result.log_likelihoods.size() - 2] : 1.0;
    const bool still =
        (next - x).cwiseAbs().maxCoeff() < settings.tolerance || std::abs(gain) < negligible_gain;
    result.status = still ? NoiseStatus::converged : NoiseStatus::iterations_exhausted;
    if (still) return;
    if (i < settings.max_iterations) x = next;
  }
}

}  // namespace

NoiseEstimate estimate_noise(const NoisyFilterFactory& make_filter, const Gaussian& initial,
                             const Measurements& measurements, const NoiseSettings& settings) {
  if (settings.max_iterations < 1 || !(settings.tolerance > 0.0))
    throw std::invalid_argument("max_iterations is " + std::to_string(settings.max_iterations) +
                                " and tolerance " + std::to_string(settings.tolerance) +
                                "; expected at least 1 and more than 0");
  NoiseLevels levels(make_filter, initial, measurements, settings);
  if (measurements.size() == 0)
    throw std::invalid_argument("the record has no samples; expected at least one");
  NoiseEstimate result;
  VectorXd x = VectorXd::Zero(levels.size());
  if (settings.method == NoiseMethod::maximum_likelihood)
    ascend(levels, settings, x, result);
  else
    iterate(levels, settings, x, result);
  result.levels = x.array().exp();
  result.noise = levels.noise(x);
  result.initial = levels.initial(x);
  result.log_likelihood = result.log_likelihoods.back();
  result.relative_deviations.setConstant(levels.size(), std::numeric_limits<double>::infinity());
  if (result.status != NoiseStatus::failed) {
    const Quadratic local = differences(levels, x, levels.log_likelihood(x));
    if (local.curvature.allFinite()) result.relative_deviations = standard_errors(local.curvature);
  }
  if (result.status == NoiseStatus::failed) result.reason = "the filter fails at these noise levels";
  if (result.status == NoiseStatus::iterations_exhausted)
    result.reason =
        "not converged after " + std::to_string(result.log_likelihoods.size() - 1) + " iterations";
  result.runs = levels.runs();
  return result;
}

namespace {

void require_square_level(const MatrixXd& matrix, Index size, const char* name) {
  if (matrix.rows() != size || matrix.cols() != size || !matrix.allFinite())
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(matrix.rows()) + " x " +
                                std::to_string(matrix.cols()) + "; expected finite numbers, " +
                                std::to_string(size) + " x " + std::to_string(size));
}

void check_groups(const std::vector<std::vector<Index>>& groups, const MatrixXd& noise, bool may_be_zero,
                  const std::string& kind) {
  std::vector<bool> taken(static_cast<std::size_t>(noise.rows()), false);
  for (const auto& group : groups) {
    if (group.empty()) throw std::invalid_argument("a group of " + kind + "s is empty; expected members");
    for (const Index i : group) {
      if (i < 0 || i >= noise.rows())
        throw std::invalid_argument(kind + " " + std::to_string(i) + " does not exist; expected 0 to " +
                                    std::to_string(noise.rows() - 1));
      if (taken[static_cast<std::size_t>(i)])
        throw std::invalid_argument(kind + " " + std::to_string(i) + " is in two groups; expected one");
      taken[static_cast<std::size_t>(i)] = true;
      if (!(noise(i, i) > 0.0) && !may_be_zero)
        throw std::invalid_argument("the noise of " + kind + " " + std::to_string(i) + " is guessed to be " +
                                    std::to_string(noise(i, i)) + "; expected more than 0, to be scaled");
    }
  }
}

bool diagonal(const MatrixXd& matrix) {
  return (matrix - MatrixXd(matrix.diagonal().asDiagonal())).isZero(0.0);
}

}  // namespace

NoiseLevels::NoiseLevels(const NoisyFilterFactory& make_filter, const Gaussian& initial,
                         const Measurements& measurements, const NoiseSettings& settings)
    : make_filter_(make_filter),
      initial_(initial),
      measurements_(measurements),
      settings_(settings),
      outputs_(settings.output_groups) {
  const Index outputs = measurements.outputs.rows(), states = initial.mean.size();
  check_measurements(measurements, outputs);
  require_square_level(settings.guess.output, outputs, "the guess of the output noise");
  if (settings.guess.process.size() > 0 || !settings.process_groups.empty())
    require_square_level(settings.guess.process, states, "the guess of the process noise");
  if (outputs_.empty())
    for (Index i = 0; i < outputs; ++i) outputs_.push_back({i});
  check_groups(outputs_, settings.guess.output, measurements.output_deviations.size() > 0, "output");
  check_groups(settings.process_groups, settings.guess.process, false, "state");
  if (settings.method == NoiseMethod::expectation_maximisation) check_diagonal();
  if (settings.likelihoods && (settings.initial_level || measurements.output_deviations.size() > 0))
    throw std::invalid_argument("likelihoods of noises, and a level of something else; expected one of them");
  size_ = static_cast<Index>(outputs_.size() + settings.process_groups.size()) + settings.initial_level;
}

void NoiseLevels::check_diagonal() const {
  if (diagonal(settings_.guess.output) && diagonal(settings_.guess.process)) return;
  throw std::invalid_argument("expectation-maximisation needs noises that are not correlated");
}

VectorXd NoiseLevels::scales(const std::vector<std::vector<Index>>& groups, Index first, Index size,
                             const VectorXd& x) const {
  VectorXd result = VectorXd::Ones(size);
  for (const auto& group : groups) {
    for (const Index i : group) result[i] = std::exp(x[first]);
    ++first;
  }
  return result;
}

Noise NoiseLevels::noise(const VectorXd& x) const {
  const VectorXd output = scales(outputs_, 0, settings_.guess.output.rows(), x);
  Noise result{settings_.guess.process, output.asDiagonal() * settings_.guess.output * output.asDiagonal()};
  if (settings_.process_groups.empty()) return result;
  const VectorXd process =
      scales(settings_.process_groups, static_cast<Index>(outputs_.size()), initial_.mean.size(), x);
  result.process = process.asDiagonal() * settings_.guess.process * process.asDiagonal();
  return result;
}

Gaussian NoiseLevels::initial(const VectorXd& x) const {
  if (!settings_.initial_level) return initial_;
  const double s = std::exp(x[size_ - 1]);
  return {initial_.mean, initial_.covariance * (s * s), initial_.factor * s};
}

Measurements NoiseLevels::measurements(const VectorXd& x) const {
  Measurements result = measurements_;
  if (result.output_deviations.size() > 0)
    result.output_deviations =
        scales(outputs_, 0, measurements_.outputs.rows(), x).asDiagonal() * measurements_.output_deviations;
  return result;
}

std::vector<double> NoiseLevels::log_likelihoods(const std::vector<VectorXd>& places) {
  runs_ += static_cast<int>(places.size());
  const bool own = measurements_.output_deviations.size() > 0;
  std::vector<double> result;
  if (settings_.likelihoods) {
    std::vector<Noise> noises;
    for (const VectorXd& x : places) noises.push_back(noise(x));
    result = settings_.likelihoods(noises);
  } else {
    for (const VectorXd& x : places) {
      const std::unique_ptr<Filter> filter = make_filter_(noise(x));
      const FilterRun one =
          own ? run(*filter, initial(x), measurements(x)) : run(*filter, initial(x), measurements_);
      result.push_back(one.failure ? std::numeric_limits<double>::quiet_NaN() : one.log_likelihood);
    }
  }
  for (double& value : result)
    if (!std::isfinite(value)) value = -std::numeric_limits<double>::infinity();
  return result;
}

// One iteration of expectation-maximisation [shumway1982]. With means over the samples, and expectations
// given the whole record, from the smoother:
//
//     s_R^2 = mean E[(y_i - h_i(z))^2] / R0_ii,  s_Q^2 = mean E[w_i^2] / Q0_ii,  s_P^2 = E[|P0^-1/2 (z_0 -
//     m_0)|^2] / r

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
