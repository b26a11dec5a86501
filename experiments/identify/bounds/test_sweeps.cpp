#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/bounds/described_motion.hpp"
#include "fem/assembly.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Index most_sweep_coordinates = 100;  // of a model that a longer record than described is worth

Index samples_of(const Identifiability& result) {
  return static_cast<Index>(std::llround(result.duration * result.sampling_rate)) + 1;
}

/// Nodes of the mesh that can move, evenly thinned.
std::vector<double> places(const Experiment& experiment, int most) {
  const fem::Beam& beam = experiment.structure.beam();
  const VectorXd nodes = fem::assemble(beam, experiment.elements).mesh.positions();
  const auto held = [&](double position) {
    return std::any_of(beam.supports.begin(), beam.supports.end(), [&](const fem::Support& support) {
      return support.deflection && std::abs(support.position - position) < 1e-9 * beam.length();
    });
  };
  const Index count = std::min<Index>(most + 1, nodes.size());
  std::vector<double> chosen;
  for (Index i = 0; i < count; ++i)
    if (const double node = nodes[i * (nodes.size() - 1) / (count - 1)]; !held(node)) chosen.push_back(node);
  return chosen;
}

}  // namespace

void sweep_in_time(const ObservedMotion& motion, const std::vector<NoisyChannel>& channels,
                   Identifiability& result) {
  const Index samples = samples_of(result);
  const double rate = 1.0 / motion.interval;
  const double per_period = rate / result.frequencies_hz.front();
  const Index most = motion.inputs.size() > 0 ? motion.inputs.cols()
                     : motion.model.motion_size() > most_sweep_coordinates
                         ? samples
                         : longest_record * (samples - 1) + 1;
  const std::vector<Index> lengths = record_lengths(per_period, samples, most);
  const std::vector<Index> every = strides(per_period, samples);
  std::vector<Reading> readings;
  for (const Index length : lengths) readings.push_back({length, 1});
  for (const Index stride : every) readings.push_back({samples, stride});
  const std::vector<ChannelInformation> found = channel_information(motion, readings);

  const auto first = static_cast<std::ptrdiff_t>(lengths.size());
  const std::vector<ChannelInformation> in_length(found.begin(), found.begin() + first);
  const std::vector<ChannelInformation> in_rate(found.begin() + first, found.end());
  result.lengths.at.resize(first);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    result.lengths.at[static_cast<Index>(i)] = static_cast<double>(lengths[i] - 1) * motion.interval;
    if (lengths[i] == samples) result.described_length = static_cast<Index>(i);
  }
  result.lengths.percent = bounds_percent(motion, in_length, channels);
  result.rates.at.resize(static_cast<Index>(every.size()));
  result.rates.beside.resize(static_cast<Index>(every.size()));
  for (std::size_t i = 0; i < every.size(); ++i) {
    const double sampled = rate / static_cast<double>(every[i]);
    result.rates.at[static_cast<Index>(i)] = sampled;
    result.rates.beside[static_cast<Index>(i)] =
        static_cast<double>(std::count_if(result.frequencies_hz.begin(), result.frequencies_hz.end(),
                                          [&](double frequency) { return frequency < 0.5 * sampled; }));
  }
  result.rates.percent = bounds_percent(motion, in_rate, channels);

  const auto information = information_about_unknowns(
      motion, in_length[static_cast<std::size_t>(result.described_length)], channels);
  result.report = filters::determined_combinations(information, VectorXd::Ones(information.unknowns()));
  result.parameters = parameter_bounds(motion, result.report);
}

void sweep_in_place(const Experiment& experiment, const std::filesystem::path& folder,
                    const std::vector<NoisyChannel>& described, Identifiability& result,
                    const Progress& progress) {
  const IdentifiabilitySettings& settings = experiment.identifiability;
  if (!experiment.structure.has_positions()) {
    result.notes.push_back(fmt::format("Other places of sensors are not tried on a {}: they have no order.",
                                       experiment.structure.kind()));
    return;
  }
  const Index samples = samples_of(result);
  // The force is asked for as long as in the test itself, so that it ends at the same sample.
  const auto begin = static_cast<Index>(std::llround(result.begin * result.sampling_rate));
  TestView view{{}, samples + begin, result.begin + result.duration, settings.force_measured};
  for (const Identifiability::UsedSensor& used : result.sensors) view.sensors.push_back(used.sensor);
  const auto own = static_cast<Index>(view.sensors.size());
  const std::vector<double> grid = places(experiment, settings.places);
  if (grid.empty()) {
    result.notes.push_back(
        fmt::format("Of {} places none can move; more [identifiability] places would.", settings.places + 1));
    return;
  }
  Sensor moved = result.sensors[static_cast<std::size_t>(described.front().channel)].sensor;
  const double noise = described.front().deviation;
  std::vector<NoisyChannel> candidates;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    moved.position = grid[i];
    moved.name = fmt::format("x{:g}m", grid[i]);
    view.sensors.push_back(moved);
    candidates.push_back({own + static_cast<Index>(i), noise});
  }
  const DescribedMotion test = described_motion(experiment, folder, view, progress);
  const ChannelInformation record = channel_information(test.motion, {{samples, 1}}).front();
  result.places.at = VectorXd::Map(grid.data(), static_cast<Index>(grid.size()));
  result.places.percent = bounds_percent_alone(test.motion, record, candidates);

  const std::vector<AddedChannel> added =
      add_best(test.motion, record, described, candidates, settings.more_sensors);
  const auto count = static_cast<Index>(described.size());
  result.numbers.at = VectorXd::LinSpaced(static_cast<Index>(added.size()) + 1, static_cast<double>(count),
                                          static_cast<double>(count + static_cast<Index>(added.size())));
  result.numbers.percent.resize(result.numbers.at.size(), result.lengths.percent.cols());
  result.numbers.percent.row(0) = bounds_percent(test.motion, {record}, described);
  result.numbers.beside = VectorXd::Constant(result.numbers.at.size(), std::nan(""));
  for (std::size_t i = 0; i < added.size(); ++i) {
    const auto row = static_cast<Index>(i) + 1;
    result.numbers.percent.row(row) = added[i].percent.transpose();
    result.numbers.beside[row] = grid[added[i].candidate];
  }
}

}  // namespace beamid::experiments
