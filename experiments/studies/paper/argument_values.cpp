// The keys of results.json that the argument of the study rests on: specificity, covariances, alternatives.
#include "experiments/studies/paper/report.hpp"

namespace beamid::experiments::paper {
namespace {

using ArgumentJson = nlohmann::ordered_json;

ArgumentJson digits_of(const std::vector<DigitCase>& cases) {
  ArgumentJson list = ArgumentJson::array();
  for (const DigitCase& one : cases)
    list.push_back({{"data", one.data},
                    {"filter", one.scheme},
                    {"observed", one.observed},
                    {"stiffness_error_percent", one.stiffness_error_percent},
                    {"damping_error_percent", one.damping_error_percent},
                    {"prints_the_published_digits", one.prints_the_published_digits()}});
  return list;
}

ArgumentJson covariances_of(const CovarianceOutcome& outcome) {
  ArgumentJson list = ArgumentJson::array();
  for (const CovarianceCase& one : outcome.cases)
    list.push_back({{"varied", one.varied},
                    {"value", one.value},
                    {"stiffness_error_percent", one.stiffness_error_percent},
                    {"damping_error_percent", one.damping_error_percent}});
  return list;
}

ArgumentJson channels_of(const std::vector<ChannelCase>& cases) {
  ArgumentJson list = ArgumentJson::array();
  for (const ChannelCase& one : cases)
    list.push_back({{"motion", one.motion},
                    {"observed", one.observed},
                    {"displacement_noise_m", one.displacement_noise},
                    {"velocity_noise_m_per_s", one.velocity_noise},
                    {"assumed_variance", one.assumed_variance},
                    {"mean_nis", {{"forward_euler", one.euler_square}, {"exponential", one.exact_square}}},
                    {"lag_one_correlation",
                     {{"forward_euler", one.euler_correlation}, {"exponential", one.exact_correlation}}}});
  return list;
}

ArgumentJson predictions_of(const std::vector<Prediction>& predictions) {
  ArgumentJson list = ArgumentJson::array();
  for (const Prediction& p : predictions)
    list.push_back({{"name", p.beam},
                    {"damping_difference_n_s_per_m", p.damping_difference},
                    {"damping_ratio_difference", p.damping_ratio_difference},
                    {"least_damping_error_percent", 100.0 * p.least_relative_error},
                    {"amplitude_ratio_after_four_cycles", p.amplitude_after_four_cycles},
                    {"assumed_measured_drop", p.measured_drop},
                    {"assumed_reproduced_drop", p.reproduced_drop}});
  return list;
}

ArgumentJson alternatives_of(const std::vector<AlternativeCase>& cases) {
  const auto numbers = [](const Eigen::VectorXd& v) { return std::vector<double>(v.begin(), v.end()); };
  ArgumentJson list = ArgumentJson::array();
  for (const AlternativeCase& one : cases)
    list.push_back({{"name", one.name},
                    {"stiffness_error_percent", numbers(one.stiffness_error_percent)},
                    {"damping_error_percent", numbers(one.damping_error_percent)},
                    {"with_process_noise_damping_error_percent", numbers(one.noisy_damping_error_percent)}});
  return list;
}

ArgumentJson starts_of(const std::vector<StartCase>& cases) {
  const auto found = [](double error, bool is_lost) {
    return ArgumentJson{{"status", is_lost ? "diverged" : "converged"},
                        {"damping_error_percent", is_lost ? ArgumentJson() : ArgumentJson(error)}};
  };
  ArgumentJson list = ArgumentJson::array();
  for (const StartCase& one : cases)
    list.push_back({{"first_sample", one.sample},
                    {"initial_stiffness_ratio", one.guess_over_truth},
                    {"modes", one.modes},
                    {"exponential", found(one.exact_error_percent, one.exact_lost)},
                    {"forward_euler", found(one.euler_error_percent, one.euler_lost)}});
  return list;
}

ArgumentJson steps_of(const StepOutcome& outcome) {
  ArgumentJson list = ArgumentJson::array();
  for (const StepCase& one : outcome.steps)
    list.push_back({{"interval_s", one.interval},
                    {"exponential_damping_ratio", one.exact_ratio},
                    {"forward_euler_damping_ratio", one.euler_ratio},
                    {"predicted_damping_ratio", one.predicted_ratio},
                    {"mean_nis", {{"exponential", one.exact_square}, {"forward_euler", one.euler_square}}}});
  return {
      {"beam", outcome.beam}, {"steps", list}, {"extrapolated_damping_ratio", outcome.extrapolated_ratio}};
}

}  // namespace

nlohmann::ordered_json argument_values(const Outcome& outcome) {
  ArgumentJson argument;
  argument["generator_and_filter"] = digits_of(outcome.digits);
  argument["covariances"] = covariances_of(outcome.covariances);
  argument["step_by_step"] = {{"stiffness_n_per_m", outcome.covariances.step_by_step.stiffness},
                              {"damping_n_s_per_m", outcome.covariances.step_by_step.damping}};
  argument["two_channels"] = channels_of(outcome.channels);
  argument["predictions"] = predictions_of(outcome.predictions);
  argument["alternatives"] = alternatives_of(outcome.alternatives);
  argument["start_sample"] = starts_of(outcome.start.starts);
  argument["initial_estimate"] = starts_of(outcome.start.guesses);
  argument["number_of_modes"] = starts_of(outcome.start.counts);
  argument["start_curve"] = starts_of(outcome.start.curve);
  argument["step_size"] = steps_of(outcome.step);
  return argument;
}

}  // namespace beamid::experiments::paper
