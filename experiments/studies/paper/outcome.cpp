#include "experiments/studies/paper/outcome.hpp"

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/text/countdown.hpp"

namespace beamid::experiments::paper {
namespace {

SchemeOutcome examine_case(const std::string& scheme, const Oscillator& truth) {
  SchemeOutcome outcome;
  outcome.scheme = scheme;
  outcome.predicted = seen_through(scheme, truth, validation_interval);
  outcome.ekf = validate("ekf", scheme, {});
  outcome.ukf = validate("ukf", scheme, {});
  outcome.displacement_only = validate("ekf", scheme, bias_settings());
  return outcome;
}

BeamOutcome examine_case(const TestBeam& test, int number, std::uint64_t seed, int trials) {
  BeamOutcome outcome;
  outcome.beam = prepare(test);
  const BeamCase& beam = outcome.beam;
  outcome.settings = tuned_settings(beam);
  const Record record = measure_acceleration(beam.released, sensor_noise, seed, stream_of(number, 0));
  outcome.motion = process(record, outcome.settings);
  outcome.analysis = analyse(beam, record, outcome.motion);
  for (std::size_t i = 0; i < variants.size(); ++i) {
    outcome.identified[i] =
        identify(beam, outcome.motion, outcome.settings, variants[i].filter, variants[i].scheme);
    outcome.predicted[i] = seen_through(variants[i].scheme, beam.reference, record.interval());
  }
  const BeamSettings wide = wide_settings(beam);
  outcome.wide_true = identify(beam, true_motion(beam), wide, "ekf", "exponential");
  const filters::Measurements processed = process(record, wide);
  outcome.wide_processed = identify(beam, processed, wide, "ekf", "exponential");
  outcome.wide_euler = identify(beam, processed, wide, "ekf", "forward_euler");
  outcome.wide_zero_phase =
      identify(beam, process(record, zero_phase_wide_settings(beam)), wide, "ekf", "exponential");
  const BeamSettings zero_phase = zero_phase_settings(beam);
  outcome.zero_phase = identify(beam, process(record, zero_phase), zero_phase, "ekf", "exponential");
  outcome.trials = repeat(beam, number, trials, seed);
  return outcome;
}

}  // namespace

Outcome investigate(std::uint64_t seed, int trials, const Progress& progress) {
  Outcome outcome;
  outcome.seed = seed;
  outcome.truth = validation_truth();
  progress("simulated oscillator");
  for (const std::string& scheme : compared_schemes())
    outcome.schemes.push_back(examine_case(scheme, outcome.truth));
  ValidationSettings literal;
  literal.initial_variance.tail<2>().setConstant(1e-5);
  outcome.literal_variance_large = validate("ekf", "forward_euler", literal);
  literal.release = release_of(test_beams[0]).tip_deflection;
  outcome.literal_variance = validate("ekf", "forward_euler", literal);
  Countdown countdown(progress, test_beams.size() * static_cast<std::size_t>(trials), "trials");
  for (std::size_t i = 0; i < test_beams.size(); ++i) {
    countdown.begin(std::string("beam ") + test_beams[i].name);
    outcome.beams.push_back(examine_case(test_beams[i], static_cast<int>(i), seed, trials));
    countdown.count(static_cast<std::size_t>(trials));
  }
  progress("specificity, covariances and alternatives");
  outcome.digits = examine_digits();
  outcome.covariances = vary_covariances();
  const BeamOutcome &light = outcome.beams[0], &second = outcome.beams[1];
  outcome.channels = examine_channels(second.beam, seed);
  std::vector<const BeamCase*> beams;
  for (const BeamOutcome& o : outcome.beams) {
    beams.push_back(&o.beam);
    outcome.predictions.push_back(predict(o.beam));
  }
  outcome.alternatives = examine_alternatives(beams);
  outcome.start = vary_start(light.beam);
  outcome.step = vary_step(second.beam, second.motion, second.settings);
  return outcome;
}

}  // namespace beamid::experiments::paper
