#include "filters/batch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
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

namespace {

// The log-likelihood of a lane that has run.
double log_likelihood_of(const TrialGroup::Lane& done) {
  const double log_root = std::log(done.mantissa) + static_cast<double>(done.exponent) * std::numbers::ln2;
  const double constant = static_cast<double>(done.measured) * std::log(2.0 * std::numbers::pi);
  return -0.5 * (done.sum_of_squares + 2.0 * log_root + constant);
}

// Runs `count` trials in groups of as many as there are lanes.
// @param group what they have in common
// @param lane_of(i) where the numbers of trial i lie @param take(i, lane) what came of it
template <class LaneOf, class Take>
void run_in_groups(TrialGroup& group, std::size_t count, const LaneOf& lane_of, const Take& take) {
  const std::size_t lanes = algorithms::avx2_is_usable() ? 4 : 2;
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t used = std::min(lanes, count - first);
    for (std::size_t lane = lanes; lane-- > 0;)  // those without a trial repeat the last one
      group.lanes[lane] = lane_of(first + std::min(lane, used - 1));
    run_any(group);
    for (std::size_t lane = 0; lane < used; ++lane) take(first + lane, group.lanes[lane]);
  }
}

}  // namespace

std::vector<TrialResult> run_batch(const OscillatorTrials& kind, const std::vector<LaneTrial>& trials,
                                   Start start) {
  check(kind, trials);
  if (trials.empty()) return {};
  const MatrixXd process =
      kind.process_noise.size() > 0 ? kind.process_noise : MatrixXd(MatrixXd::Zero(4, 4));
  std::vector<TrialResult> results(trials.size());
  std::vector<MatrixXd> covariances;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    covariances.push_back(with_covariance(trials[i].initial).covariance);
    results[i].last = {Eigen::VectorXd(4), MatrixXd(4, 4)};
  }
  using Motion = TrialGroup::Motion;
  TrialGroup group{kind.forward_euler ? Motion::forward_euler : Motion::exact,
                   kind.mass,
                   0.0,
                   kind.interval,
                   static_cast<int>(kind.observed.size()),
                   {},
                   trials[0].outputs.cols(),
                   start == Start::one_interval_before,
                   {}};
  std::copy(kind.observed.begin(), kind.observed.end(), group.observed);
  const auto lane_of = [&](std::size_t i) {
    return TrialGroup::Lane{trials[i].outputs.data(),
                            trials[i].initial.mean.data(),
                            covariances[i].data(),
                            process.data(),
                            kind.output_noise.data(),
                            results[i].last.mean.data(),
                            results[i].last.covariance.data(),
                            0.0,
                            1.0,
                            0,
                            0,
                            -1};
  };
  run_in_groups(group, trials.size(), lane_of, [&](std::size_t i, const TrialGroup::Lane& done) {
    results[i].log_likelihood = log_likelihood_of(done);
    if (done.failed >= 0) results[i].failed = done.failed;
  });
  return results;
}

std::vector<double> ringing_log_likelihoods(const RingingTrials& kind, const std::vector<Noise>& noises) {
  require(kind.frequency > 0.0 && kind.interval > 0.0, "frequency or interval", "not positive",
          "more than 0");
  require(kind.initial.mean.size() == 5, "size of the initial mean", std::to_string(kind.initial.mean.size()),
          "5");
  require_covariance(kind.initial.covariance, 5, "initial covariance");
  for (const Noise& noise : noises) {
    require_covariance(noise.process, 5, "process noise");
    require_covariance(noise.output, 1, "output noise");
  }
  TrialGroup group{
      TrialGroup::Motion::ringing, 0.0, kind.frequency, kind.interval, 1, {}, kind.signal.size(), false, {}};
  Eigen::VectorXd mean(5);  // where each ended, unused
  MatrixXd covariance(5, 5);
  const auto lane_of = [&](std::size_t i) {
    return TrialGroup::Lane{kind.signal.data(),
                            kind.initial.mean.data(),
                            kind.initial.covariance.data(),
                            noises[i].process.data(),
                            noises[i].output.data(),
                            mean.data(),
                            covariance.data(),
                            0.0,
                            1.0,
                            0,
                            0,
                            -1};
  };
  std::vector<double> result(noises.size());
  run_in_groups(group, noises.size(), lane_of, [&](std::size_t i, const TrialGroup::Lane& done) {
    result[i] = done.failed >= 0 ? -std::numeric_limits<double>::infinity() : log_likelihood_of(done);
  });
  return result;
}

}  // namespace beamid::filters
