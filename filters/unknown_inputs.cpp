#include "filters/unknown_inputs.hpp"

#include <stdexcept>

#include "filters/state_entries.hpp"

namespace beamid::filters {

OptionSpec unknown_inputs_option() {
  return {"inputs", std::vector<double>{}, "",
          "entries of the state that are unknown inputs, counted from 0; empty: those called "
          "unknown_input_1, ..."};
}

std::vector<Eigen::Index> find_unknown_inputs(const std::string& filter, const DiscreteModel& model,
                                              const std::vector<double>& stated) {
  const std::vector<Label> labels = model.state_labels();
  if (!stated.empty()) return state_entries(filter + ": inputs", stated, labels.size());
  const std::string begins = "unknown_input_", rate = "_rate";
  std::vector<Eigen::Index> found;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::string& name = labels[i].name;
    if (!name.starts_with(begins)) continue;
    if (name.ends_with(rate))
      throw std::invalid_argument(
          filter + ": " + name.substr(0, name.size() - rate.size()) +
          " has a rate of its own, by which it is known beforehand; expected the process "
          "random_walk or ornstein_uhlenbeck");
    found.push_back(static_cast<Eigen::Index>(i));
  }
  return found;
}

}  // namespace beamid::filters
