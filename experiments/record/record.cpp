#include "experiments/record/record.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace beamid::experiments {

const char* si_unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::displacement:
      return "m";
    case Quantity::velocity:
      return "m/s";
    case Quantity::acceleration:
    case Quantity::base_acceleration:
    case Quantity::support_acceleration:
      return "m/s2";
    case Quantity::force:
      return "N";
    case Quantity::strain:
      return "m/m";
    case Quantity::angular_acceleration:
    case Quantity::support_angular_acceleration:
      return "rad/s2";
  }
  return "";
}

const char* to_string(Quantity quantity) {
  switch (quantity) {
    case Quantity::displacement:
      return "displacement";
    case Quantity::velocity:
      return "velocity";
    case Quantity::acceleration:
      return "acceleration";
    case Quantity::force:
      return "force";
    case Quantity::strain:
      return "strain";
    case Quantity::base_acceleration:
      return "base_acceleration";
    case Quantity::support_acceleration:
      return "support_acceleration";
    case Quantity::angular_acceleration:
      return "angular_acceleration";
    case Quantity::support_angular_acceleration:
      return "support_angular_acceleration";
  }
  return "";
}

Eigen::VectorXd Record::channel(Quantity quantity) const {
  for (Eigen::Index i = 0; i < samples.rows(); ++i)
    if (channels[i].quantity == quantity) return samples.row(i).transpose();
  throw std::invalid_argument(std::string("the record has no channel of ") + to_string(quantity));
}

std::vector<std::string> Record::channel_names() const {
  std::vector<std::string> names;
  for (const Channel& channel : channels) {
    const bool alone = std::count_if(channels.begin(), channels.end(),
                                     [&](const Channel& other) { return other.name == channel.name; }) == 1;
    names.push_back(alone ? channel.name : channel.name + " " + to_string(channel.quantity));
  }
  return names;
}

Record Record::window(double from, double to) const {
  constexpr Eigen::Index fewest = 16;
  const double slack = 0.5 * interval();
  const double* const first = std::lower_bound(time.data(), time.data() + size(), from - slack);
  const double* const last = std::upper_bound(time.data(), time.data() + size(), to + slack);
  const Eigen::Index begin = first - time.data(), count = last - first;
  if (!(from >= time[0] - slack && to <= time[size() - 1] + slack) || count < fewest) {
    std::ostringstream message;
    message << "window " << from << " to " << to << " s; expected at least " << fewest
            << " samples inside the record, which runs from " << time[0] << " to " << time[size() - 1]
            << " s";
    throw std::invalid_argument(message.str());
  }
  Record part = *this;
  part.time = time.segment(begin, count);
  part.samples = samples.middleCols(begin, count);
  return part;
}

}  // namespace beamid::experiments
