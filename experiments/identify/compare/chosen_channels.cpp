#include "experiments/identify/compare/chosen_channels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

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
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < all.channels.size(); ++i)
    if (is_input(all.channels[i].quantity) ||
        std::find(names.begin(), names.end(), all.channels[i].name) != names.end())
      kept.push_back(static_cast<Eigen::Index>(i));

  Record record = all;
  record.samples = all.samples(kept, Eigen::all);
  record.channels.clear();
  for (const Eigen::Index i : kept) record.channels.push_back(all.channels[static_cast<std::size_t>(i)]);
  if (compared.sensor_noise.size() > 0) compared.sensor_noise = compared.sensor_noise(kept).eval();
  compared.record = std::move(record);
  return compared;
}

}  // namespace beamid::experiments
