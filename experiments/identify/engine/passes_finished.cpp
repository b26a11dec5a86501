// What is worked out once the passes of a run are done.
#include <fmt/format.h>

#include <cmath>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/engine/passes.hpp"
#include "experiments/identify/engine/run_bound.hpp"
#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/scheme_bias.hpp"
#include "filters/smoother.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using SteadyClock = std::chrono::steady_clock;

std::string unsettled_text(double moved) {
  return fmt::format(
      "Not settled: its last pass moved an unknown by {:.2g} standard deviations. More passes ([compare] "
      "passes) or nearer initial estimates are needed.",
      moved);
}

// Its error of a pole over the pole is of order dt: the bias of a damping ratio is as large as the ratio.
bool is_of_first_order(const std::string& scheme) {
  return filters::bias_series(*filters::scheme_registry().make(scheme, {}), 1).front() != 0.0;
}

}  // namespace

void Passes::finish() {
  const SteadyClock::time_point start = SteadyClock::now();
  run_.unknowns = run_.model->unknowns;
  run_.last_move = last_move_;
  if (!has_settled()) run_.remarks.push_back(unsettled_text(last_move_));
  const MatrixXd noise =
      noise_of_bound(context_.compared, known_, run_.noise_left, run_.noise).cwiseAbs2().asDiagonal();
  const auto discrete = finest(*run_.model, dt_, noise);
  if (nearest_with_own_scheme()) motion_ = reproduce(*discrete, motion_.initial_state, directions_, record_);
  if (context_.compared.clocks_are_aligned) take_clocks(*discrete);
  score(input_bounds_.size() > 0
            ? input_bounds_
            : run_bounds(*discrete, *run_.model, motion_.initial_state, directions_, record_));
  const bool drifts = has_noise(run_.settings.input_noise);  // what one motion leaves is not the noise then
  const bool is_kept = settings_.keep == filters::Keep::all_estimates;
  const bool inputs_are_asked = !drifts && context_.analysis.forced() && context_.compared.clocks.empty();
  if (inputs_are_asked && is_weighed_at_once())
    run_.likeliest_clocks =
        likeliest_clocks(*discrete, motion_.initial_state, directions_, record_, motion_.outputs);
  if (is_kept && context_.analysis.modal && context_.compared.clocks.empty())
    look_at_free_modes(context_, motion_.outputs, motion_.initial_state, run_);
  if (!drifts && (!nearest_with_own_scheme() || !context_.analysis.modal)) weigh_noise();
  if (context_.analysis.forced()) look_at_sections();
  // What is left of a model that is not exact looks like noise of its inputs, too.
  if (inputs_are_asked && is_kept && !is_approximate(run_)) look_for_input_noise();
  run_.response_seconds += seconds_since(start);
  if (settings_.keep == filters::Keep::last_estimate) return;
  if (first_start_.size() > 0)
    run_.batch = identify_batch(*run_.model, run_.settings, first_start_, directions_.all(), record_);
  if (!context_.experiment.smoother.empty() && has_noise(run_.settings.input_noise))
    run_.remarks.emplace_back("No smoothed history: it is worked out for inputs without noise only.");
  else if (!context_.experiment.smoother.empty()) {
    const auto filtered = filters::discretise(run_.model->motion, dt_, run_.settings.discretisation,
                                              {{}, run_.settings.output_noise});
    run_.smoothed = filters::smooth(run_.run, *filtered, record_, context_.experiment.smoother).estimates;
  }
}

void Passes::judge_motion() {
  const auto& shown = context_.analysis.mode;
  const VectorXd& state = run_.run.last.mean;
  const std::optional<double> record_hz = shown ? std::optional(shown->frequency_hz) : std::nullopt;
  const auto modes = recorded_modes(*run_.model, state, run_.unknown_state, record_hz);
  if (modes) run_.mode = modes->shown;
  FoundMode found = run_.mode.value_or(FoundMode{});
  // A motion that makes most of the record is the record's, whatever stands out of its spectrum: where
  // something drives a structure that need not be a mode.
  constexpr double most_left = 30.0;  // %
  const bool is_the_records = is_linear_and_driven() && motion_.response_error_percent < most_left;
  double lowest_hz = modes ? modes->lowest.frequency_hz : 0.0;
  if (!dynamic_cast<const filters::LinearMotion*>(run_.model->motion.get())) {
    if (!shown) return;
    const auto of_motion =
        recorded_frequency(run_.reproduced.row(0), record_.inputs, dt_, shown->frequency_hz);
    if (!of_motion.value_hz) return;
    found.frequency_hz = lowest_hz = *of_motion.value_hz;
  }
  if (lowest_hz > 0.0) run_.frequency_hz = lowest_hz;
  found.frequency_hz = shown_at(found.frequency_hz, 1.0 / dt_);
  run_.reason = divergence(found, is_the_records ? std::nullopt : record_hz);
  if (!run_.reason.empty()) run_.status = ComparedRun::Status::diverged;
}

// Whether the sensitivities of all samples are no more than can be held together.
bool Passes::is_weighed_at_once() const {
  const Index columns = directions_.motion.cols() + directions_.unknowns.cols();
  return record_.outputs.size() * columns <= most_sensitivities;
}

// Where no one mode says what of the noise counts.
void Passes::weigh_noise() {
  if (!is_weighed_at_once()) return;
  const auto discrete = finest(*run_.model, dt_, run_.settings.output_noise);
  run_.noise_in = noise_in_estimates(*discrete, motion_.initial_state, directions_, record_,
                                     record_.outputs - motion_.outputs);
}

void Passes::look_at_sections() {
  const auto modes = recorded_modes(*run_.model, run_.run.last.mean, run_.unknown_state, {});
  if (!modes) return;
  const filters::Gaussian known = known_about_start(started_, setting_, record_.outputs);
  run_.sections = section_scatter(*run_.model, record_, known, run_.unknown_state.mean,
                                  modes->lowest.frequency_hz, run_.settings.input_noise);
  // Of a short record they say less than its lines do, where those are left white, and nothing where a
  // scheme's bias is larger than what they scatter.
  constexpr double white = 1e-3;
  const bool innovations_are_white = run_.diagnostics && run_.diagnostics->consistency &&
                                     run_.diagnostics->consistency->whiteness_p_value > white;
  if (run_.sections && !run_.sections->is_long() &&
      (innovations_are_white || is_of_first_order(settings_.discretisation)))
    run_.sections.reset();
}

// Lags that are unknown too leave less of the record to the unknowns.
void Passes::take_clocks(filters::DiscreteModel& discrete) {
  const std::vector<OwnClock>& clocks = context_.compared.clocks;
  run_.clocks = clock_step(
      clock_information(discrete, motion_.initial_state, directions_, record_, motion_.outputs, clocks),
      static_cast<Index>(clocks.size()));
  const VectorXd& w = run_.clocks->widening;
  MatrixXd& own = run_.unknown_state.covariance;
  own = w.asDiagonal() * own * w.asDiagonal();
  MatrixXd& all = run_.run.last.covariance;
  const std::vector<Index>& places = run_.model->unknown_places;
  if (all.size() > 0) all(places, places) = own;
}

void Passes::score(const VectorXd& bound) {
  const std::vector<Estimate> found = estimates(*run_.model, run_.run.last);
  for (std::size_t j = 0; j < found.size(); ++j) {
    ComparedParameter parameter{found[j], {}, {}};
    if (context_.compared.truth)
      parameter.truth = true_value(*context_.compared.truth, settings_.true_mass, run_.model->unknowns[j]);
    const double wider = run_.clocks ? run_.clocks->widening[static_cast<Index>(j)] : 1.0;
    if (const double least = wider * bound[static_cast<Index>(j)]; std::isfinite(least))
      parameter.bound = least;
    run_.parameters.push_back(parameter);
  }
  run_.reproduced = motion_.outputs;
  run_.response_error_percent = motion_.response_error_percent;
  run_.misfit_percent = motion_.misfit_percent;
}

}  // namespace beamid::experiments
