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

}  // namespace beamid::experiments::paper
