// The unknowns by all samples at once, where the filter's end is not to be had or not to be kept.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/engine/noise_in_estimates.hpp"
#include "experiments/identify/engine/passes.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "filters/batch_estimator.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Of the whole state, before the record.
filters::Gaussian Passes::known_beforehand() const {
  const JointModel& model = *run_.model;
  filters::Gaussian known = initial_estimate(model, with_guess(directions_, model, started_.guess));
  known.mean(model.unknown_places) = started_.guess.mean(started_.model.unknown_places);
  return known;
}

NoisyInputFit Passes::fit_with_input_noise(const IdentificationSettings& settings) const {
  std::vector<bool> noise_is_known;
  for (const double configured : known_.configured) noise_is_known.push_back(configured > 0.0);
  return fit_noisy_inputs(*run_.model, settings, known_beforehand(), run_.run.last.mean, record_,
                          noise_is_known);
}

// Of inputs that are said to be exact, beside innovations that exact ones do not leave.
void Passes::look_for_input_noise() {
  constexpr double not_white = 1e-3, worth_fitting = 3.0;
  constexpr double well_known = 0.1;  // of a hit 0.15 of the noise moved a stiffness by eight deviations
  if (is_nonlinear(*run_.model) || is_whole_mesh(*run_.model)) return;
  if (run_.diagnostics && run_.diagnostics->consistency &&
      run_.diagnostics->consistency->whiteness_p_value > not_white)
    return;
  context_.progress("noise of the inputs");
  IdentificationSettings noisy = run_.settings;
  noisy.discretisation = finest_discretisation(*run_.model, dt_);
  run_.likeliest_input_noise =
      likeliest_input_noise(*run_.model, noisy, known_beforehand(), run_.run.last.mean, record_);
  if (!run_.likeliest_input_noise) return;
  LikeliestInputNoise& found = *run_.likeliest_input_noise;
  const filters::Gaussian& exact = run_.unknown_state;
  const filters::Gaussian prior{
      started_.guess.mean(started_.model.unknown_places), started_.guess.unknowns, {}};
  auto lines = driven_problem(*run_.model, record_, prior);
  try {
    if (lines) {  // noise of the outputs need not be white
      lines->weights.setOnes(record_.outputs.rows());
      const VectorXd sizes = root_mean_squares(record_.inputs.topRows(lines->parts.front().inputs.rows()));
      const double gain = input_noise_gain(*lines, exact.mean, sizes);
      found.gain = std::min(found.gain, gain);
      if (!std::isfinite(gain)) lines.reset();  // what their ends could be is most of a narrow resonance
    }
    if (!(found.gain > worth_fitting)) return;
    if (lines) found.deviation = likeliest_line_noise(*lines, exact.mean, found.deviation).inputs;
    noisy.input_noise = found.deviation;
    const NoisyInputFit fit = fit_with_input_noise(noisy);
    if (!fit.failure.empty()) return;
    found.moved = (fit.unknowns.mean - exact.mean).cwiseQuotient(exact.covariance.diagonal().cwiseSqrt());
    if (!lines) return;
    // At unknowns that are not those of exact inputs.
    const LevelsOfNoise levels = likeliest_line_noise(*lines, fit.unknowns.mean, found.deviation);
    if (!(levels.relative_deviation.maxCoeff() < well_known)) return;
    found.deviation = levels.inputs, found.outputs = levels.outputs, found.whiteness_p = levels.whiteness_p;
  } catch (const std::runtime_error&) {  // no motion there
  }
}

// A filter of motion and unknowns together is biased by the noise of its inputs (innovation_likelihood.hpp).
void Passes::fit_inputs_noise() {
  if (!has_noise(run_.settings.input_noise)) return;
  const auto start = std::chrono::steady_clock::now();
  const NoisyInputFit fit = fit_with_input_noise(run_.settings);
  run_.seconds += seconds_since(start);
  if (!fit.failure.empty()) {
    run_.remarks.push_back(
        "The noise of the inputs counts in the filter alone, which it biases: " + fit.failure + ".");
    return;
  }
  take_unknowns(fit.unknowns);
  input_bounds_ = fit.bounds;
  constexpr double mostly = 0.5;
  if (fit.noise_scale < mostly)
    run_.remarks.push_back(
        fmt::format("Input noise, passed through the structure, causes most of the residual. The output "
                    "noise is taken as {:.2g} times the residual. Both together then explain the size of the "
                    "innovations.",
                    std::sqrt(fit.noise_scale)));
}

// In place of the filter's.
void Passes::take_unknowns(const filters::Gaussian& unknowns) {
  const std::vector<Index>& places = run_.model->unknown_places;
  filters::Gaussian& last = run_.run.last;
  last.mean(places) = unknowns.mean;
  last.covariance(places, Eigen::all).setZero();
  last.covariance(Eigen::all, places).setZero();
  last.covariance(places, places) = unknowns.covariance;
  run_.unknown_state = of_unknowns(*run_.model, last);
  last_move_ = 0.0;
  begin_at(next_start(*run_.model, run_.settings.initial, last).mean);
}

bool Passes::take_all_lines() {
  constexpr double lost = 0.6;  // of the lines
  if (!started_.guess.by_lines) return false;
  const filters::Gaussian prior{
      started_.guess.mean(started_.model.unknown_places), started_.guess.unknowns, {}};
  try {
    begin_at(started_.guess.mean);
    auto problem = driven_problem(*run_.model, record_, prior);
    if (!problem) return false;
    problem->weights = run_.noise_left.cwiseMax(1e-150).cwiseInverse();
    const DrivenFit fit = fit_driven_from(*problem, prior.mean);
    if (fit.left_share > lost) return false;
    problem->weights = fit.left.cwiseMax(1e-150).cwiseInverse();
    const MatrixXd covariance = evaluate_driven(*problem, fit.theta).covariance(prior);
    const std::string why = run_.run.failure ? failure_text(*run_.run.failure) : run_.reason;
    run_.run.failure.reset();
    run_.status = ComparedRun::Status::converged;
    run_.reason.clear();
    run_.diagnostics.reset();
    const Index n = motion_.initial_state.size();
    run_.run.last = {motion_.initial_state, MatrixXd::Zero(n, n), {}};
    run_.settings.initial = next_;
    run_.noise = assumed_noise(known_, noise_shown());
    run_.settings.output_noise = run_.noise.cwiseAbs2().asDiagonal();
    run_.unknown_start = prior;
    take_unknowns({fit.theta, covariance, {}});
    run_.remarks.push_back(fmt::format(
        "The filter lost its way ({}); the estimates are those of all lines of the spectrum (output error).",
        why));
    return true;
  } catch (const std::runtime_error&) {  // no motion there
    return false;
  }
}

// Output error from a state on, on the basis of each estimate in turn; with what is known beforehand. Absent:
// no minimum, or not of every direction. @param first_samples taken up first, from a poor state; 0: all
std::optional<filters::Gaussian> Passes::output_error(VectorXd state, Index first_samples) {
  constexpr int most_bases = 8;
  constexpr double settled = 0.1;  // of a deviation
  const std::vector<Index>& places = run_.model->unknown_places;
  filters::BatchSettings settings;
  settings.tolerance = 1e-3;
  for (int i = 0; i < most_bases; ++i) {
    settings.first_samples = i == 0 ? first_samples : 0;
    begin_at(state);
    if (!motion_.initial_state.allFinite() || !directions_.all().allFinite()) return {};
    run_.noise = assumed_noise(known_, noise_shown());
    const auto discrete = discretised(run_.noise.cwiseAbs2().asDiagonal());
    const filters::BatchEstimate found =
        filters::estimate_batch(*discrete, motion_.initial_state, directions_.all(), record_, settings);
    if (found.covariance.size() == 0) return {};
    const auto q = static_cast<Index>(places.size());
    const MatrixXd rows = directions_.all()(places, Eigen::all);
    filters::Gaussian unknowns{found.state(places), rows * found.covariance * rows.transpose(), {}};
    const VectorXd moved =
        (unknowns.mean - state(places)).cwiseQuotient(unknowns.covariance.diagonal().cwiseSqrt());
    state = found.state;
    if (moved.cwiseAbs().maxCoeff() > settled) continue;
    const MatrixXd information = unknowns.covariance.llt().solve(MatrixXd::Identity(q, q)),
                   known = started_.guess.unknowns.llt().solve(MatrixXd::Identity(q, q));
    const MatrixXd whole = (information + known).llt().solve(MatrixXd::Identity(q, q));
    const VectorXd before = started_.guess.mean(started_.model.unknown_places);
    unknowns.mean += whole * known * (before - unknowns.mean);
    unknowns.covariance = whole;
    return unknowns;
  }
  return {};
}

}  // namespace beamid::experiments
