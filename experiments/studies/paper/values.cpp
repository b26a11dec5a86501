#include "experiments/studies/paper/report.hpp"

namespace beamid::experiments::paper {
namespace {

using Json = nlohmann::ordered_json;

Json errors(const Oscillator& found, const Oscillator& truth) {
  return {{"stiffness_error_percent", stiffness_error(found, truth)},
          {"damping_error_percent", damping_error(found, truth)}};
}

Json identified(const Identification& result, const Oscillator& reference, const Oscillator& predicted) {
  Json json{{"stiffness_n_per_m", result.found.stiffness},
            {"damping_n_s_per_m", result.found.damping},
            {"damping_ratio", result.found.damping_ratio()}};
  json.update(errors(result.found, reference));
  json["predicted_stiffness_error_percent"] = stiffness_error(predicted, reference);
  json["predicted_damping_error_percent"] = damping_error(predicted, reference);
  json["stiffness_standard_deviation_n_per_m"] = result.stiffness_deviation;
  json["damping_standard_deviation_n_s_per_m"] = result.damping_deviation;
  json["status"] = lost(result, reference.frequency_hz()) ? "diverged" : "converged";
  return json;
}

Json beam_values(const BeamOutcome& o) {
  const BeamCase& beam = o.beam;
  Json json{{"name", beam.test.name},
            {"tip_mass_kg", beam.test.tip_mass},
            {"frequency_hz", beam.exact_frequency_hz},
            {"finite_element_frequency_hz", beam.released.modes.frequency_hz()[0]},
            {"assumed_damping_ratio", beam.test.first_damping_ratio},
            {"equivalent_mass_kg", beam.model.equivalent_mass},
            {"reference_stiffness_n_per_m", beam.reference.stiffness},
            {"reference_damping_n_s_per_m", beam.reference.damping},
            {"modal_analysis",
             {{"frequency_hz", o.analysis.mode.frequency_hz},
              {"damping_ratio", o.analysis.mode.damping_ratio},
              {"frequency_standard_deviation_hz", o.analysis.mode.frequency_standard_deviation_hz},
              {"damping_ratio_standard_deviation", o.analysis.mode.damping_ratio_standard_deviation},
              {"decrement_damping_ratio", o.analysis.decrement.damping_ratio}}}};
  for (std::size_t i = 0; i < variants.size(); ++i)
    json[variants[i].filter][variants[i].scheme] =
        identified(o.identified[i], beam.reference, o.predicted[i]);
  json["second_mode_velocity_m_per_s"] = second_mode_velocity(beam);
  json["wide_prior"] = {{"true_motion", errors(o.wide_true.found, beam.reference)},
                        {"paper_processing_forward_euler", errors(o.wide_euler.found, beam.reference)},
                        {"paper_processing", errors(o.wide_processed.found, beam.reference)},
                        {"zero_phase_ends_kept", errors(o.wide_zero_phase.found, beam.reference)}};
  json["wide_prior"]["zero_phase_ends_kept"]["status"] =
      lost(o.wide_zero_phase, o.analysis.mode.frequency_hz) ? "diverged" : "converged";
  json["zero_phase"] = errors(o.zero_phase.found, beam.reference);
  json["trials"] = {{"count", o.trials.trials},
                    {"diverged", o.trials.diverged},
                    {"stiffness_mean_error_percent", o.trials.stiffness_mean_percent},
                    {"damping_mean_error_percent", o.trials.damping_mean_percent},
                    {"stiffness_rms_error_percent", o.trials.stiffness_rms_percent},
                    {"damping_rms_error_percent", o.trials.damping_rms_percent},
                    {"stiffness_bound_percent", o.trials.stiffness_bound_percent},
                    {"damping_bound_percent", o.trials.damping_bound_percent},
                    {"damping_bound_ratio", o.trials.damping_bound_ratio()}};
  return json;
}

}  // namespace

Json values(const Outcome& outcome) {
  Json table2, bias, beams;
  for (const SchemeOutcome& o : outcome.schemes) {
    table2[o.scheme] = errors(o.ekf.found, outcome.truth);
    table2[o.scheme]["ukf"] = errors(o.ukf.found, outcome.truth);
    bias[o.scheme] = errors(o.displacement_only.found, outcome.truth);
    bias[o.scheme]["predicted_stiffness_error_percent"] = stiffness_error(o.predicted, outcome.truth);
    bias[o.scheme]["predicted_damping_error_percent"] = damping_error(o.predicted, outcome.truth);
  }
  for (const BeamOutcome& o : outcome.beams) beams.push_back(beam_values(o));
  Json json{{"published",
             {{"stiffness_error_percent", published_stiffness_error_percent},
              {"damping_error_percent", published_damping_error_percent}}},
            {"table2", table2},
            {"discretisation_bias", bias},
            {"printed_initial_variance",
             {{"initial_stiffness_n_per_m", ValidationSettings{}.first_stiffness},
              {"stiffness_n_per_m", outcome.literal_variance.found.stiffness},
              {"stiffness_after_large_release_n_per_m", outcome.literal_variance_large.found.stiffness}}},
            {"beams", beams}};
  json.update(argument_values(outcome));
  return json;
}

Json configuration(const Outcome& outcome) {
  const auto diagonal = [](const auto& vector) { return std::vector<double>(vector.begin(), vector.end()); };
  const auto filter_settings = [&](const BeamSettings& s) {
    return Json{{"high_pass_hz", s.high_pass_hz},
                {"low_pass_hz", s.low_pass_hz},
                {"filter_order", 2},
                {"zero_phase", s.zero_phase},
                {"skipped_s", s.skipped},
                {"skipped_at_end_s", s.skipped_at_end},
                {"noise_variance", diagonal(s.noise_variance)},
                {"initial_variance", diagonal(s.initial_variance)},
                {"initial_stiffness_n_per_m", s.first_stiffness},
                {"initial_damping_n_s_per_m", s.first_damping}};
  };
  const auto validation = [&](const ValidationSettings& s) {
    Json observed = Json::array();
    for (const Quantity quantity : s.observed) observed.push_back(to_string(quantity));
    return Json{{"observed", observed},
                {"release_m", s.release},
                {"duration_s", s.duration},
                {"noise_variance", s.noise_variance},
                {"initial_variance", diagonal(s.initial_variance)},
                {"initial_stiffness_n_per_m", s.first_stiffness},
                {"initial_damping_n_s_per_m", s.first_damping},
                {"passes", s.passes}};
  };
  const Release rig = release_of(test_beams[0]);
  const fem::Cantilever beam = steel_beam(test_beams[0]);
  Json json{{"trials", outcome.beams.front().trials.trials},
            {"oscillator",
             {{"stiffness_n_per_m", outcome.truth.stiffness},
              {"mass_kg", outcome.truth.mass},
              {"damping_ratio", outcome.truth.damping_ratio()},
              {"interval_s", validation_interval},
              {"table2", validation({})},
              {"discretisation_bias", validation(bias_settings())}}},
            {"rig",
             {{"length_m", beam.length},
              {"bending_stiffness_n_m2", beam.bending_stiffness},
              {"mass_kg", beam.mass()},
              {"elements", rig.elements},
              {"modes", rig.modes},
              {"higher_damping_ratio", rig.higher_damping_ratio},
              {"tip_deflection_m", rig.tip_deflection},
              {"duration_s", rig.duration},
              {"sampling_rate_hz", rig.sampling_rate},
              {"sensor_noise_m_per_s2", sensor_noise}}}};
  for (const BeamOutcome& o : outcome.beams)
    json["beams"][o.beam.test.name] = {
        {"tuned", filter_settings(o.settings)},
        {"zero_phase", filter_settings(zero_phase_settings(o.beam))},
        {"wide_prior", filter_settings(wide_settings(o.beam))},
        {"zero_phase_ends_kept", filter_settings(zero_phase_wide_settings(o.beam))}};
  return json;
}

// The keys of results.json that the argument of the study rests on: specificity, covariances, alternatives.

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
