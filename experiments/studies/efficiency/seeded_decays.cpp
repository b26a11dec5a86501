#include "experiments/studies/efficiency/seeded_decays.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <stdexcept>

#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/studies/identify/report.hpp"
#include "experiments/text/progress.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "filters/monte_carlo.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// A steel cantilever of 0.5 m, 25 mm x 5 mm, with 0.3 kg at its tip.
Experiment described_experiment() {
  Experiment experiment;
  fem::Section section;
  section.bending_stiffness = 210e9 * fem::rectangle_second_moment(0.025, 0.005);
  section.mass_per_length = 7850 * 0.025 * 0.005;
  experiment.structure.beam().segments = {{0.5, section}};
  experiment.structure.beam().supports = {{0.0}};
  experiment.structure.beam().bodies = {{0.5, 0.3}};
  experiment.elements = 6;
  return experiment;
}

double described_frequency() {
  static const double frequency = [] {
    const Experiment experiment = described_experiment();
    return fem::lowest_frequency_hz(fem::assemble(experiment.structure, experiment.elements));
  }();
  return frequency;
}

}  // namespace

SeededDecay seeded_decay(const SeededDecays& settings, int run) {
  const std::uint64_t seed = settings.seed + static_cast<std::uint64_t>(run);
  std::mt19937_64 generator(seed);
  const auto draw = [&](const std::pair<double, double>& range) {
    const double share = static_cast<double>(generator() >> 11) * 0x1p-53;
    return range.first * std::pow(range.second / range.first, share);
  };
  SeededDecay decay;
  decay.periods = draw(settings.periods);
  decay.damping_ratio = draw(settings.damping_ratio);
  decay.noise = draw(settings.noise);
  decay.samples_per_period = draw(settings.samples_per_period);
  decay.frequency_hz = described_frequency() / draw(settings.beam_error);
  decay.experiment = described_experiment();
  const double phase = draw({1.0, std::exp(2 * std::numbers::pi)}),
               interval = 1 / (decay.frequency_hz * decay.samples_per_period);
  const auto count = static_cast<Index>(std::ceil(decay.periods * decay.samples_per_period));
  const double w = 2 * std::numbers::pi * decay.frequency_hz, ratio = decay.damping_ratio;
  const std::complex<double> rate = w * std::complex<double>(-ratio, std::sqrt(1 - ratio * ratio)),
                             start = std::polar(1.0, std::log(phase));
  Record& record = decay.record;
  record.channels = {{Quantity::acceleration, "tip"}};
  record.time = VectorXd::LinSpaced(count, 0.0, interval * static_cast<double>(count - 1));
  record.samples = decay.noise * standard_normal(count, seed, 0).transpose();
  for (Index k = 0; k < count; ++k) record.samples(0, k) += (start * std::exp(rate * record.time[k])).real();
  return decay;
}

DecayOutcome identify_decay(const SeededDecay& decay) {
  DecayOutcome outcome;
  try {
    const RecordIdentification found = identify_record(decay.experiment, decay.record);
    if (found.judgement.verdict != ComparedRun::Status::converged) {
      outcome.failure = found.judgement.objections.back().text;
      return outcome;
    }
    const Identification& i = found.identification;
    outcome.frequency_error =
        (i.found.frequency_hz() - decay.frequency_hz) / (found.frequency_factor() * i.frequency_deviation_hz);
    outcome.damping_error = (i.found.damping_ratio() - decay.damping_ratio) /
                            (found.damping_factor() * i.damping_ratio_deviation);
  } catch (const std::exception& error) {
    outcome.failure = error.what();
  }
  return outcome;
}

int DecayOutcomes::failed() const {
  return static_cast<int>(
      std::count_if(runs.begin(), runs.end(), [](const auto& run) { return !run.failure.empty(); }));
}

int DecayOutcomes::frequency_inside() const {
  return static_cast<int>(std::count_if(runs.begin(), runs.end(), [](const auto& run) {
    return run.failure.empty() && std::abs(run.frequency_error) < quantile_95;
  }));
}

int DecayOutcomes::damping_inside() const {
  return static_cast<int>(std::count_if(runs.begin(), runs.end(), [](const auto& run) {
    return run.failure.empty() && std::abs(run.damping_error) < quantile_95;
  }));
}

DecayOutcomes seeded_decays(const SeededDecays& settings, const Progress& progress) {
  if (settings.runs < 1)
    throw std::invalid_argument("decays: " + std::to_string(settings.runs) + " runs; expected at least 1");
  Countdown countdown(progress, static_cast<std::size_t>(settings.runs), "runs");
  countdown.begin("free decays");
  DecayOutcomes outcomes{settings, std::vector<DecayOutcome>(static_cast<std::size_t>(settings.runs))};
  tbb::parallel_for(0, settings.runs, [&](int run) {
    outcomes.runs[static_cast<std::size_t>(run)] = identify_decay(seeded_decay(settings, run));
    countdown.count();
  });
  return outcomes;
}

Results report(const DecayOutcomes& outcomes) {
  const SeededDecays& s = outcomes.settings;
  Results results;
  results.command = "efficiency";
  results.seed = s.seed;
  results.configuration = {{"runs", s.runs},
                           {"periods", s.periods},
                           {"damping_ratio", s.damping_ratio},
                           {"noise_over_amplitude", s.noise},
                           {"samples_per_period", s.samples_per_period},
                           {"beam_frequency_over_record", s.beam_error}};
  results.heading("`beamid identify` on clean free decays");
  results.paragraph(fmt::format(
      "{} simulated decays of a cantilever's first mode, {:g} to {:g} periods, damping ratio {:g} to {:g} %, "
      "noise of {:g} to {:g} % of the amplitude, {:g} to {:g} samples a period. The beam as described is up "
      "to {:.0f} % off in frequency. Failed: the command ended, the filter diverged, or the modal analysis "
      "contradicted it.",
      s.runs, s.periods.first, s.periods.second, 100 * s.damping_ratio.first, 100 * s.damping_ratio.second,
      100 * s.noise.first, 100 * s.noise.second, s.samples_per_period.first, s.samples_per_period.second,
      100 * (s.beam_error.second - 1)));
  Table table{"decays", ""};
  table.column({"", "outcome"})
      .column({"decays", "decays", "{:.0f}"})
      .column({"share [%]", "percent", "{:.2f}"});
  const std::pair<const char*, int> rows[] = {
      {"failed", outcomes.failed()},
      {"frequency inside its interval", outcomes.frequency_inside()},
      {"damping ratio inside its interval", outcomes.damping_inside()}};
  for (const auto& [name, count] : rows)
    table.row({name, static_cast<double>(count), 100.0 * count / s.runs});
  results.table(table);
  results.values = {{"failed", outcomes.failed()},
                    {"frequency_inside", outcomes.frequency_inside()},
                    {"damping_ratio_inside", outcomes.damping_inside()},
                    {"failures", nlohmann::ordered_json::array()}};
  for (std::size_t run = 0; run < outcomes.runs.size(); ++run) {
    const DecayOutcome& one = outcomes.runs[run];
    if (one.failure.empty()) continue;
    results.values["failures"].push_back({{"seed", s.seed + run}, {"reason", one.failure}});
    results.paragraph(fmt::format("Seed {}: {}", s.seed + run, one.failure));
  }
  return results;
}

}  // namespace beamid::experiments
