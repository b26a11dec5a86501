// Higher modes as noise: of the five beams, or of a user's own.
#include <cmath>
#include <stdexcept>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/storey_laws.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/studies/noise/report.hpp"
#include "experiments/studies/paper/test_beams.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/text/method_choice.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

int whole(const filters::Options& options, const char* name, double from, double to) {
  const double value = options.number(name);
  if (!(value >= from && value <= to && value == std::floor(value)))
    throw std::invalid_argument(std::string(name) + " must be a whole number from " +
                                std::to_string(static_cast<int>(from)) + " to " +
                                std::to_string(static_cast<int>(to)));
  return static_cast<int>(value);
}

std::vector<NoiseBeam> five_beams(int modes) {
  std::vector<NoiseBeam> beams;
  for (const paper::TestBeam& test : paper::test_beams) {
    const fem::Cantilever beam = paper::steel_beam(test);
    Eigen::VectorXd ratios = Eigen::VectorXd::Constant(modes, Release().higher_damping_ratio);
    ratios[0] = test.first_damping_ratio;
    beams.push_back({test.name, beam, 100.0 * test.tip_mass / beam.mass(), ratios});
  }
  return beams;
}

/// The file's beam and damping; 0.5 % where it states none.
NoiseBeam described(const std::string& file, int modes) {
  const Experiment experiment = read_experiment(file);
  require_linear_storeys(experiment, "noise");
  const fem::Beam beam = at_place({file}, [&] { return experiment.structure.beam(); });
  const Eigen::VectorXd frequencies =
      fem::modes(fem::assemble(beam, experiment.elements), modes).angular_frequency;
  Eigen::VectorXd ratios = Eigen::VectorXd::Constant(modes, 0.005);
  if (!std::holds_alternative<fem::Undamped>(experiment.damping))
    ratios = fem::damping_ratios(experiment.damping, frequencies);
  return {experiment.title.empty() ? file : experiment.title, beam, 100.0 * beam.tip_mass() / beam.mass(),
          ratios};
}

class HigherModeStudy final : public Study {
 public:
  explicit HigherModeStudy(const filters::Options& options) {
    settings_.modes = whole(options, "modes", 1, 6);
    settings_.trials = whole(options, "trials", 2, 10000);
    const double seed = options.number("seed");
    if (!(seed >= 0.0 && seed == std::floor(seed) && seed < 0x1p53))
      throw std::invalid_argument("seed must be a whole number from 0");
    settings_.seed = static_cast<std::uint64_t>(seed);
    settings_.noise = options.number("noise");
    settings_.blow = options.number("blow");
    settings_.interval = options.number("interval");
    settings_.duration = options.number("duration");
    config_ = options.text("config");
    settings_.beams = config_.empty() ? five_beams(settings_.modes)
                                      : std::vector<NoiseBeam>{described(config_, settings_.modes)};
  }

  Results run(const Progress& progress) const override {
    Results results = report(study_higher_modes(settings_, progress));
    warn_of_file(results, config_);
    return results;
  }

 private:
  NoiseSettings settings_;
  std::string config_;
};

const bool noise_registered = study_registry().add(
    {"noise",
     "when a filter of one mode may take the others for noise, and what to do when not",
     "[inverse2009]",
     {{"modes", 3.0, "", "of the continuum in the records"},
      {"trials", 6.0, "", "seeded, per beam, blow and sensor"},
      {"seed", 2009.0, "", "of noise and phases; the same seed gives the same bytes"},
      {"noise", 0.001, "", "of the sensor, relative to the first mode's amplitude"},
      {"blow", 0.005, "s", "duration of the hammer's half sine"},
      {"interval", 0.004, "s", "between samples"},
      {"duration", 8.0, "s", "of a record"},
      {"config", std::string(), "", "experiment file of another beam; by default the study's five"}},
     {},
     [](const filters::Options& options) { return std::make_unique<HigherModeStudy>(options); }});

}  // namespace
}  // namespace beamid::experiments
