#include "experiments/studies/efficiency/interval_coverage.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/progress.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double corner = 1.5;

double samples_per_cycle(CoverageModel model) {
  return model == CoverageModel::oscillator || model == CoverageModel::one_mode ? 60 : 120;
}

const double covered_stiffness = 210e9 * fem::rectangle_second_moment(0.03, 0.004);  // [N m2]

/// A steel cantilever of 0.6 m, 30 mm x 4 mm, with 0.2 kg at its tip.
Experiment covered_experiment(double bending_stiffness = covered_stiffness) {
  Experiment experiment;
  fem::Section section;
  section.bending_stiffness = bending_stiffness;
  section.mass_per_length = 7850 * 0.03 * 0.004;
  experiment.structure.beam().segments = {{0.6, section}};
  experiment.structure.beam().supports = {{0.0}};
  experiment.structure.beam().bodies = {{0.6, 0.2}};
  experiment.elements = 8;
  return experiment;
}

/// Frequencies of its first three modes [Hz].
Eigen::Vector3d covered_frequencies() {
  static const Eigen::Vector3d frequencies = [] {
    const Experiment experiment = covered_experiment();
    return Eigen::Vector3d(
        fem::modes(fem::assemble(experiment.structure, experiment.elements), 3).frequency_hz().head<3>());
  }();
  return frequencies;
}

/// What a user would ask: of the beam itself from a stiffness that is 10 % off.
Experiment asked_experiment(CoverageModel model) {
  if (model == CoverageModel::oscillator) return covered_experiment();
  Experiment experiment = covered_experiment(1.1 * covered_stiffness);
  experiment.model = {"beam", model_registry().completed("beam", {})};
  const auto& reductions = reduction::reduction_registry();
  if (model == CoverageModel::mesh)
    experiment.reduction = {"none", reductions.completed("none", {})};
  else
    experiment.reduction = {
        "modal_truncation",
        reductions.completed("modal_truncation", {{"modes", model == CoverageModel::one_mode ? 1.0 : 3.0}})};
  return experiment;
}

/// Gaussian noise (N) of deviation one. A density of 1/f from first-order low-passes two octaves apart.
VectorXd noise_of(NoiseColour colour, Index count, double cycles_per_sample, std::uint64_t seed) {
  constexpr Index settle = 4000;
  const auto low_passed = [&](double frequency, std::uint64_t stream) {
    const double keep = std::exp(-2 * std::numbers::pi * frequency * cycles_per_sample);
    VectorXd noise = standard_normal(count + settle, seed, stream);
    for (Index k = 1; k < noise.size(); ++k)
      noise[k] = keep * noise[k - 1] + std::sqrt(1 - keep * keep) * noise[k];
    return VectorXd(noise.tail(count));
  };
  if (colour == NoiseColour::low_passed) return low_passed(corner, 0);
  VectorXd noise = standard_normal(count, seed, 0);
  if (colour == NoiseColour::white) return noise;
  constexpr int octave_pairs = 5;
  VectorXd flicker = VectorXd::Zero(count);
  for (int i = 0; i < octave_pairs; ++i)
    flicker += low_passed(std::pow(4.0, i - 2), static_cast<std::uint64_t>(i) + 1);
  return std::sqrt(0.5) * (noise + flicker / std::sqrt(static_cast<double>(octave_pairs)));
}

using Errors = std::array<double, 2>;  // of frequency and damping ratio, over the deviations told

std::optional<Errors> errors_of(const RecordIdentification& found, double frequency, double damping_ratio) {
  const Identification& i = found.identification;
  if (i.run.failure) return {};
  return Errors{
      (i.found.frequency_hz() - frequency) / (found.frequency_factor() * i.frequency_deviation_hz),
      (i.found.damping_ratio() - damping_ratio) / (found.damping_factor() * i.damping_ratio_deviation)};
}

std::optional<Errors> errors_of(const ComparedRun& run, double stiffness, double damping_ratio) {
  if (!run.has_estimate()) return {};
  Errors errors{};
  for (const ComparedParameter& one : run.parameters) {
    const bool damping = one.estimate.name == "damping_ratio";
    errors[damping ? 1 : 0] =
        (one.estimate.value - (damping ? damping_ratio : stiffness)) / one.estimate.deviation;
  }
  return errors;
}

/// `identify` as it is without options.
std::optional<Errors> identified_errors(const CoverageSettings& settings, const Experiment& experiment,
                                        Record record) {
  const bool one = settings.model == CoverageModel::oscillator || settings.model == CoverageModel::one_mode;
  Experiment oscillator = experiment;  // what is noise to one mode, whatever model asks
  oscillator.model = Experiment{}.model;
  oscillator.reduction = Experiment{}.reduction;
  if (one)
    if (const auto step = step_against_higher_modes(oscillator, record)) record = prepare(record, {*step});
  if (settings.model == CoverageModel::oscillator)
    return errors_of(identify_record(experiment, record), covered_frequencies()[0], settings.damping_ratio);
  const Comparison found = identify_with_model(experiment, measured_record("", record), {}, unwatched);
  return errors_of(found.runs.at(0), covered_stiffness, settings.damping_ratio);
}

CoverageCase summary(NoiseColour colour, const std::vector<std::optional<Errors>>& errors) {
  CoverageCase one{colour, static_cast<int>(errors.size()), 0, {}, {}, {}};
  for (const auto& error : errors) {
    one.failed += !error;
    for (std::size_t q = 0; error && q < error->size(); ++q) {
      one.inside[q] += std::abs((*error)[q]) < quantile_95;
      one.mean[q] += (*error)[q] / one.runs;
      one.mean_square[q] += (*error)[q] * (*error)[q] / one.runs;
    }
  }
  return one;
}

}  // namespace

const char* to_string(NoiseColour colour) {
  switch (colour) {
    case NoiseColour::white:
      return "white";
    case NoiseColour::low_passed:
      return "low-passed";
    default:
      return "white and 1/f";
  }
}

const char* to_string(CoverageModel model) {
  switch (model) {
    case CoverageModel::one_mode:
      return "one_mode";
    case CoverageModel::three_modes:
      return "three_modes";
    case CoverageModel::mesh:
      return "mesh";
    default:
      return "sdof";
  }
}

CoverageModel coverage_model(const std::string& name) {
  for (const CoverageModel model :
       {CoverageModel::oscillator, CoverageModel::one_mode, CoverageModel::three_modes, CoverageModel::mesh})
    if (name == to_string(model)) return model;
  throw std::invalid_argument("unknown model '" + name + "'; expected sdof, one_mode, three_modes or mesh");
}

Record covered_record(const CoverageSettings& settings, NoiseColour colour, std::uint64_t seed) {
  const bool oscillator = settings.model == CoverageModel::oscillator;
  const Eigen::Vector3d own = covered_frequencies();
  const double per_cycle = samples_per_cycle(settings.model), frequency = own[0],
               dt = 1 / (per_cycle * frequency);
  const auto count = static_cast<Index>(std::lround(settings.cycles * per_cycle));
  Record record;
  record.channels = {{Quantity::acceleration, "tip"}};
  record.time = VectorXd::LinSpaced(count, 0.0, dt * static_cast<double>(count - 1));
  record.samples = settings.noise * noise_of(colour, count, 1 / per_cycle, seed).transpose();
  const std::array<double, 3> amplitudes{1, settings.higher[0], settings.higher[1]};
  const std::array<double, 3> multiples{1, oscillator ? 8.3 : own[1] / own[0],
                                        oscillator ? 24.1 : own[2] / own[0]};
  for (std::size_t m = 0; m < 3; ++m) {
    const double ratio = m == 0 || !oscillator ? settings.damping_ratio : settings.damping_ratio / 2,
                 w = 2 * std::numbers::pi * frequency * multiples[m];
    const std::complex<double> rate = w * std::complex<double>(-ratio, std::sqrt(1 - ratio * ratio)),
                               start = std::polar(amplitudes[m], 0.7 + static_cast<double>(m));
    for (Index k = 0; k < count; ++k)
      record.samples(0, k) += (start * std::exp(rate * record.time[k])).real();
  }
  return record;
}

Coverage interval_coverage(const CoverageSettings& settings, const Progress& progress) {
  if (settings.runs < 2)
    throw std::invalid_argument("coverage: " + std::to_string(settings.runs) + " runs; expected at least 2");
  const Experiment experiment = asked_experiment(settings.model);
  Coverage result{settings, {}};
  Countdown countdown(progress, settings.colours.size() * static_cast<std::size_t>(settings.runs), "runs");
  for (const NoiseColour colour : settings.colours) {
    countdown.begin(std::string("intervals in noise that is ") + to_string(colour));
    std::vector<std::optional<Errors>> errors(static_cast<std::size_t>(settings.runs));
    tbb::parallel_for(0, settings.runs, [&](int run) {
      errors[static_cast<std::size_t>(run)] = identified_errors(
          settings, experiment,
          covered_record(settings, colour, settings.seed + static_cast<std::uint64_t>(run)));
      countdown.count();
    });
    result.cases.push_back(summary(colour, errors));
  }
  return result;
}

}  // namespace beamid::experiments
