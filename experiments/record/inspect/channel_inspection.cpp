#include "experiments/record/inspect/channel_inspection.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "experiments/record/inspect/noise_floor.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/units.hpp"
#include "experiments/signal/median.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Even samples without a hole, for what looks at a whole signal: straight lines across what is missing.
struct EvenSignal {
  VectorXd time, signal;
  double interval = 1;
};

EvenSignal even_signal(const std::vector<double>& time, const VectorXd& samples, double resolution) {
  constexpr Index fewest = 16;
  std::vector<Index> kept;  // stamps that come after all before them
  for (Index k = 0; k < samples.size(); ++k)
    if (kept.empty() || time[k] > time[static_cast<std::size_t>(kept.back())]) kept.push_back(k);
  Record record;
  record.time = Eigen::Map<const VectorXd>(time.data(), samples.size())(kept);
  record.samples = samples(kept).transpose();
  record.channels.resize(1);
  record.time_resolution = resolution;
  if (record.size() >= fewest && !evenly_sampled(record))
    step_registry().make("resample", step_registry().completed("resample", {}))->apply(record);
  const double interval = record.size() > 1 ? record.interval() : 1;
  return {record.time, bridged_straight(record.samples.row(0).transpose()), interval};
}

/// Rests between pulses, as a hammer's force does: nothing in it is then too short or held for too long.
bool rests(const InspectedChannel& channel) {
  constexpr double smallest = 0.05, most_of_it = 0.95;
  std::vector<double> distance;
  for (const double value : channel.samples)
    if (std::isfinite(value)) distance.push_back(std::abs(value - channel.offset));
  if (distance.empty()) return false;
  const double level = smallest * *std::max_element(distance.begin(), distance.end());
  const auto resting = std::count_if(distance.begin(), distance.end(), [&](double d) { return d <= level; });
  const auto longest = [&] {  // of what goes further: a spike is one sample, and most of them are alone
    std::size_t run = 0, most = 0;
    for (const double d : distance) most = std::max(most, run = d > level ? run + 1 : 0);
    return most;
  }();
  return static_cast<double>(resting) > most_of_it * static_cast<double>(distance.size()) && longest > 2;
}

}  // namespace

InspectedChannel make_channel(const RecordTable& table, std::size_t index,
                              const ColumnDescription* described) {
  InspectedChannel channel;
  channel.column = static_cast<int>(index) + 1;
  channel.samples = table.columns[index];
  if (index < table.names.size()) channel.name = table.names[index];
  if (index < table.units.size()) channel.unit = table.units[index];
  double factor = 1.0;
  if (described != nullptr && described->stated)
    channel.quantity = described->quantity, factor = described->factor;
  else if (const auto meaning = stated_meaning(table, index); meaning && meaning->quantity)
    channel.quantity = *meaning->quantity, factor = meaning->factor;
  if (channel.quantity) {
    channel.unit = si_unit(*channel.quantity);
    for (const Unit& unit : units(*channel.quantity))
      if (unit.factor == factor) channel.file_unit = unit.symbol;
  }
  for (double& value : channel.samples) value *= factor;
  return channel;
}

void inspect_channel(const Inspection& found, InspectedChannel& channel) {
  constexpr Index fewest = 64;
  std::vector<double> finite;
  for (const double value : channel.samples)
    if (std::isfinite(value)) finite.push_back(value);
  channel.missing = channel.samples.size() - finite.size();
  if (finite.empty()) {
    channel.defects.dead = true;
    return;
  }
  channel.offset = median(finite);
  channel.least = *std::min_element(finite.begin(), finite.end());
  channel.greatest = *std::max_element(finite.begin(), finite.end());
  const bool force = channel.quantity ? *channel.quantity == Quantity::force : rests(channel);
  channel.defects = find_defects(channel.samples, force ? SignalKind::force : SignalKind::motion);
  if (channel.defects.dead || std::ssize(finite) < fewest) return;
  VectorXd samples = Eigen::Map<const VectorXd>(channel.samples.data(), std::ssize(channel.samples));
  for (const auto* runs : {&channel.defects.spikes, &channel.defects.dropped})
    for (const Run& run : *runs)
      samples.segment(static_cast<Index>(run.first), static_cast<Index>(run.length))
          .setConstant(std::nan(""));
  const auto [time, signal, interval] = even_signal(found.time, samples, found.resolution);
  if (signal.size() < fewest) return;
  const VectorXd place = VectorXd::LinSpaced(signal.size(), -0.5, 0.5);
  channel.drift = place.dot(signal) / place.squaredNorm();
  channel.noise = noise_floor(signal);
  const double power = (signal.array() - signal.mean()).square().mean();
  const double noise = channel.noise * channel.noise;
  channel.signal_to_noise_db =
      10 * std::log10(std::max(power - noise, 1e-3 * noise) / std::max(noise, 1e-300));
  if (!(signal.maxCoeff() > signal.minCoeff())) return;
  channel.frequency_hz = strongest_frequency(signal, interval);
  channel.events = find_events(signal, interval, channel.noise, channel.frequency_hz);
  take_slow_release(signal, interval, channel.frequency_hz, channel.events);
  if (!channel.events.empty() && channel.events.front().pulse) channel.frequency_hz = 0;  // pulses have none
  if (channel.frequency_hz > 0)
    channel.wandering = offset_drift(signal, 1 / (channel.frequency_hz * interval), channel.noise);
  for (SignalEvent& event : channel.events) {
    const auto at =
        std::lower_bound(found.time.begin(), found.time.end(), time[event.sample] - 0.5 * interval);
    event.sample = std::min<Index>(at - found.time.begin(), std::ssize(found.time) - 1);
  }
  if (channel.wandering)
    channel.wandering->settled =
        std::lower_bound(found.time.begin(), found.time.end(),
                         time[std::min(channel.wandering->settled, time.size() - 1)]) -
        found.time.begin();
}

}  // namespace beamid::experiments
