// The bias of every discretisation, over steps and damping ratios, and for a user's own beam.
#include <cmath>
#include <stdexcept>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/storey_laws.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/studies/atlas/input_hold_report.hpp"
#include "experiments/studies/atlas/many_degrees.hpp"
#include "experiments/studies/atlas/report.hpp"
#include "experiments/studies/study.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

/// The first mode of the beam that an experiment file describes; its sampling rate, when it states one.
AtlasSettings described(const std::string& file, AtlasSettings settings) {
  const Experiment experiment = read_experiment(file);
  require_linear_storeys(experiment, "atlas");
  const fem::Modes modes = fem::modes(fem::assemble(experiment.structure, experiment.elements), 1);
  double ratio = settings.beam.damping_ratio();
  if (!std::holds_alternative<fem::Undamped>(experiment.damping))
    ratio = fem::damping_ratios(experiment.damping, modes.angular_frequency)[0];
  settings.beam = Oscillator::from_frequency(1.0, modes.angular_frequency[0], ratio);
  if (experiment.format.sampling_rate) settings.interval = 1.0 / *experiment.format.sampling_rate;
  return settings;
}

class AtlasStudy final : public Study {
 public:
  explicit AtlasStudy(const filters::Options& options) {
    const double frequency = options.number("frequency"), ratio = options.number("damping_ratio");
    if (!(frequency > 0.0)) throw std::invalid_argument("frequency must be above 0 Hz");
    if (!(ratio > 0.0 && ratio < 1.0)) throw std::invalid_argument("damping_ratio must be between 0 and 1");
    settings_.beam = Oscillator::from_frequency(1.0, 2.0 * std::numbers::pi * frequency, ratio);
    settings_.interval = options.number("interval");
    config_ = options.text("config");
    if (!config_.empty()) settings_ = described(config_, settings_);
  }

  Results run(const Progress& progress) const override {
    Results results = report(make_atlas(settings_, progress));
    add_hold_page(make_hold_page(settings_, progress), settings_.beam, results);
    add_degrees_page(make_degrees_page(progress), results);
    warn_of_file(results, config_);
    return results;
  }

 private:
  AtlasSettings settings_;
  std::string config_;
};

const bool atlas_registered = study_registry().add(
    {"atlas",
     "what every discretisation does to stiffness and damping, in closed form and measured",
     "[hairer1996]",
     {{"frequency", 3.4555, "Hz", "of the mode that is asked about; by default that of the beam S(11.8)"},
      {"damping_ratio", 0.0045, "", "of it"},
      {"interval", 0.004, "s", "between samples"},
      {"config", std::string(), "",
       "experiment file whose beam's first mode, damping and sampling rate to take"}},
     {},
     [](const filters::Options& options) { return std::make_unique<AtlasStudy>(options); }});

}  // namespace
}  // namespace beamid::experiments
