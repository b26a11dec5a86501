#include "filters/batch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

#include "filters/batch_avx2.hpp"
#include "filters/covariance_factor.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters {
namespace {

using algorithms::TrialGroup, Eigen::Index, Eigen::MatrixXd;

std::string size_of(const MatrixXd& matrix) {
  return std::to_string(matrix.rows()) + " x " + std::to_string(matrix.cols());
}

void require(bool fits, const std::string& what, const std::string& found, const std::string& expected) {
  if (!fits) throw std::invalid_argument(what + " is " + found + "; expected " + expected);
}

void require_covariance(const MatrixXd& matrix, Index size, const std::string& what) {
  const std::string expected = std::to_string(size) + " x " + std::to_string(size);
  require(matrix.rows() == size && matrix.cols() == size, what, size_of(matrix), expected);
  require(is_covariance(matrix), what, "not a covariance", "finite, symmetric and positive semidefinite");
}

void check(const OscillatorTrials& kind, const std::vector<LaneTrial>& trials) {
  const auto outputs = static_cast<Index>(kind.observed.size());
  const auto positive = [](double value, const char* what) {
    require(value > 0.0 && std::isfinite(value), what, std::to_string(value), "a positive number");
  };
  positive(kind.mass, "mass [kg]");
  positive(kind.interval, "interval [s]");
  require(outputs >= 1 && outputs <= 3, "number of outputs", std::to_string(outputs), "1 to 3");
  require_covariance(kind.output_noise, outputs, "output noise");
  if (kind.process_noise.size() > 0) require_covariance(kind.process_noise, 4, "process noise");
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const std::string of = " of trial " + std::to_string(i);
    const LaneTrial& trial = trials[i];
    const Index samples = trials[0].outputs.cols();
    require(trial.outputs.rows() == outputs && trial.outputs.cols() == samples, "record" + of,
            size_of(trial.outputs), std::to_string(outputs) + " x " + std::to_string(samples));
    require(trial.initial.mean.size() == 4, "size of the initial mean" + of,
            std::to_string(trial.initial.mean.size()), "4");
    require(trial.initial.mean.allFinite(), "initial mean" + of, "not finite", "numbers");
    require_covariance(with_covariance(trial.initial).covariance, 4, "initial covariance" + of);
  }
}

void run_any(TrialGroup& group) {
  if (algorithms::avx2_is_usable()) return algorithms::run_group_avx2(group);
  algorithms::run_group<2, algorithms::Baseline>(group);
}

}  // namespace

bool algorithms::processor_has_avx2() {
  if (std::getenv("BEAMID_BASELINE") != nullptr) return false;
#ifdef __x86_64__  // compilers have the function for these processors only
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

bool algorithms::avx2_is_usable() {
  static const bool usable = compiled_for_avx2() && processor_has_avx2();
  return usable;
}

std::string batch_instructions() {
  return algorithms::avx2_is_usable() ? "avx2" : "baseline";
}

std::vector<TrialResult> run_batch(const OscillatorTrials& kind, const std::vector<LaneTrial>& trials,
                                   Start start) {
  check(kind, trials);
  const MatrixXd process =
      kind.process_noise.size() > 0 ? kind.process_noise : MatrixXd(MatrixXd::Zero(4, 4));
  std::vector<TrialResult> results(trials.size());
  const std::size_t lanes = algorithms::avx2_is_usable() ? 4 : 2;
  for (std::size_t first = 0; first < trials.size(); first += lanes) {
    MatrixXd covariances[TrialGroup::most];
    TrialGroup group{kind.mass,
                     kind.interval,
                     static_cast<int>(kind.observed.size()),
                     {},
                     kind.output_noise.data(),
                     process.data(),
                     trials[0].outputs.cols(),
                     start == Start::one_interval_before,
                     kind.forward_euler,
                     {}};
    std::copy(kind.observed.begin(), kind.observed.end(), group.observed);
    const std::size_t used = std::min(lanes, trials.size() - first);
    for (std::size_t lane = lanes; lane-- > 0;) {  // those without a trial repeat the last one
      const std::size_t i = first + std::min(lane, used - 1);
      covariances[lane] = with_covariance(trials[i].initial).covariance;
      if (results[i].last.mean.size() == 0) results[i].last = {Eigen::VectorXd(4), MatrixXd(4, 4)};
      group.lanes[lane] = {trials[i].outputs.data(),
                           trials[i].initial.mean.data(),
                           covariances[lane].data(),
                           results[i].last.mean.data(),
                           results[i].last.covariance.data(),
                           0.0,
                           1.0,
                           0,
                           0,
                           -1};
    }
    run_any(group);
    for (std::size_t lane = 0; lane < used; ++lane) {
      const TrialGroup::Lane& done = group.lanes[lane];
      const double log_root =
          std::log(done.mantissa) + static_cast<double>(done.exponent) * std::numbers::ln2;
      const double constant = static_cast<double>(done.measured) * std::log(2.0 * std::numbers::pi);
      TrialResult& result = results[first + lane];
      result.log_likelihood = -0.5 * (done.sum_of_squares + 2.0 * log_root + constant);
      if (done.failed >= 0) result.failed = done.failed;
    }
  }
  return results;
}

}  // namespace beamid::filters
