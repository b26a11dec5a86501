#include "experiments/identify/compare/chosen_channels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace beamid::experiments {

ComparedRecord chosen_channels(ComparedRecord compared, const std::vector<std::string>& names) {
  const Record& all = compared.record;
  std::vector<std::string> known;
  for (const Channel& channel : all.channels)
    if (!is_input(channel.quantity)) known.push_back(channel.name);
  for (const std::string& name : names)
    if (const auto found = std::count(known.begin(), known.end(), name); found != 1)
      throw std::invalid_argument(fmt::format("{} channel of motion named '{}'; the record has {}",
                                              found == 0 ? "no" : "more than one", name,
                                              fmt::join(known, ", ")));
  std::vector<bool> kept;
  for (const Channel& channel : all.channels)
    kept.push_back(is_input(channel.quantity) ||
                   std::find(names.begin(), names.end(), channel.name) != names.end());
  return with_channels(std::move(compared), kept);
}

ComparedRecord with_channels(ComparedRecord compared, const std::vector<bool>& kept) {
  const std::vector<Channel> all = std::exchange(compared.record.channels, {});
  std::vector<Eigen::Index> rows, outputs;  // among channels, and among those of motion
  Eigen::Index output = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const bool measured = !is_input(all[i].quantity);
    if (kept[i]) {
      rows.push_back(static_cast<Eigen::Index>(i));
      compared.record.channels.push_back(all[i]);
      if (measured) outputs.push_back(output);
    }
    output += measured;
  }
  compared.record.samples = compared.record.samples(rows, Eigen::all).eval();
  if (compared.sensor_noise.size() > 0) compared.sensor_noise = compared.sensor_noise(rows).eval();
  if (compared.quiet_noise.size() > 0) compared.quiet_noise = compared.quiet_noise(outputs).eval();
  return compared;
}

}  // namespace beamid::experiments
