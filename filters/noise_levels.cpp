#include "filters/noise_levels.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

double NoiseLevels::log_likelihood(const VectorXd& x) {
  ++runs_;
  const std::unique_ptr<Filter> filter = make_filter_(noise(x));
  const bool own = measurements_.output_deviations.size() > 0;
  const FilterRun result =
      own ? run(*filter, initial(x), measurements(x)) : run(*filter, initial(x), measurements_);
  return result.failure || !std::isfinite(result.log_likelihood) ? -std::numeric_limits<double>::infinity()
                                                                 : result.log_likelihood;
}

}  // namespace beamid::filters
