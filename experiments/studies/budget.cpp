// The error budget of a pipeline from acceleration to K and C: of the five beams, or of a user's own.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/storey_laws.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/studies/budget/report.hpp"
#include "experiments/studies/paper/beam_identification.hpp"
#include "experiments/studies/paper/monte_carlo.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/text/method_choice.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

struct Named {
  std::string name;
  PipelineSettings settings;
};

std::vector<Named> five_beams(const PipelineSettings& common) {
  std::vector<Named> result;
  for (const paper::TestBeam& test : paper::test_beams) {
    const Release release = paper::release_of(test);
    PipelineSettings settings = common;
    settings.beam = release.beam;
    settings.elements = release.elements;
    settings.damping_ratios = Eigen::VectorXd::Constant(release.modes, release.higher_damping_ratio);
    settings.damping_ratios[0] = release.first_damping_ratio;
    settings.stream = paper::stream_of(static_cast<int>(result.size()), 0);
    result.push_back({test.name, settings});
  }
  return result;
}

/// The file's beam, damping, release, sampling rate and duration; 0.5 % where it states no damping.
Named described(const std::string& file, PipelineSettings settings) {
  const Experiment experiment = read_experiment(file);
  require_linear_storeys(experiment, "budget");
  const fem::Beam beam = at_place({file}, [&] { return experiment.structure.beam(); });
  settings.beam = beam;
  settings.elements = experiment.elements;
  const fem::StructuralSystem system = fem::assemble(beam, experiment.elements);
  const Eigen::VectorXd frequencies =
      fem::modes(system, std::min<Eigen::Index>(8, system.size())).angular_frequency;
  settings.damping_ratios = Eigen::VectorXd::Constant(frequencies.size(), 0.005);
  if (!std::holds_alternative<fem::Undamped>(experiment.damping))
    settings.damping_ratios = fem::damping_ratios(experiment.damping, frequencies);
  if (experiment.excitation.deflection) settings.deflection = std::abs(*experiment.excitation.deflection);
  settings.sampling_rate = experiment.format.sampling_rate.value_or(experiment.simulation.sampling_rate);
  settings.duration = std::max(experiment.simulation.duration, settings.duration);
  return {experiment.title.empty() ? file : experiment.title, settings};
}

class BudgetStudy final : public Study {
 public:
  explicit BudgetStudy(const filters::Options& options) {
    const double seed = options.number("seed"), orders = options.number("orders");
    if (!(seed >= 0.0 && seed == std::floor(seed) && seed < 0x1p53))
      throw std::invalid_argument("seed must be a whole number from 0");
    if (!(orders >= 2.0 && orders <= 1000.0 && std::fmod(orders, 2.0) == 0.0))
      throw std::invalid_argument("orders must be an even number from 2 to 1000");
    orders_ = static_cast<int>(orders);
    PipelineSettings common;
    common.seed = static_cast<std::uint64_t>(seed);
    common.sensor_noise = options.number("noise");
    common.sensor_bias = options.number("bias");
    common.sensor_mass = options.number("sensor_mass");
    common.amplitude_damping = options.number("amplitude_damping");
    if (!(common.sensor_noise > 0.0)) throw std::invalid_argument("noise must be above 0 m/s2");
    if (!std::isfinite(common.sensor_bias)) throw std::invalid_argument("bias must be finite");
    if (!(common.sensor_mass >= 0.0)) throw std::invalid_argument("sensor_mass must not be negative");
    if (!(common.amplitude_damping >= 0.0))
      throw std::invalid_argument("amplitude_damping must not be negative");
    config_ = options.text("config");
    beams_ = config_.empty() ? five_beams(common) : std::vector<Named>{described(config_, common)};
  }

  Results run(const Progress& progress) const override {
    std::vector<Budget> budgets;
    for (std::size_t i = 0; i < beams_.size(); ++i) {
      const std::string part = beams_.size() > 1 ? fmt::format("beam {} of {}, ", i + 1, beams_.size()) : "";
      budgets.push_back(make_budget(beams_[i].name, beams_[i].settings, orders_,
                                    [&](const std::string& what) { progress(part + what); }));
    }
    Results results = report(budgets, orders_);
    warn_of_file(results, config_);
    return results;
  }

 private:
  std::vector<Named> beams_;
  int orders_ = 2;
  std::string config_;
};

const bool budget_registered = study_registry().add(
    {"budget",
     "what each cause, from the beam to the filter, contributes to the errors of K and C",
     "[inverse2009], [shapley1953]",
     {{"seed", 2009.0, "", "seed of the sensor noise; the same seed gives the same bytes"},
      {"orders", 2.0, "", "number of orders of the causes to average over; even"},
      {"noise", 0.05, "m/s2", "standard deviation of the accelerometer's white noise"},
      {"bias", 0.02, "m/s2", "its constant offset (assumed)"},
      {"sensor_mass", 0.002, "kg", "of sensor and cable that the model does not count (assumed)"},
      {"amplitude_damping", 0.02, "", "growth of the damping at the amplitude of the release (assumed)"},
      {"config", std::string(), "", "experiment file of another beam; by default the study's five"}},
     {},
     [](const filters::Options& options) { return std::make_unique<BudgetStudy>(options); }});

}  // namespace
}  // namespace beamid::experiments
