// Which entries of a state are inputs that nobody measured.
#pragma once

#include <string>
#include <vector>

#include "filters/discrete_model.hpp"
#include "filters/options.hpp"

namespace beamid::filters {

namespace contract {
/// Estimates inputs of which nothing is known, entries of the state called unknown_input_1, ...: within a
/// tenth of their rms where sensors read them directly and, beside, the motion.
inline constexpr const char* unknown_inputs = "unknown_inputs";
}  // namespace contract

/// The option `inputs` of filters that treat unknown inputs apart from the state.
OptionSpec unknown_inputs_option();

/// Places in the state, as stated or, where none are, of the labels "unknown_input_1", ... (LatentInputs).
/// @param filter for messages
/// @throws std::invalid_argument on a place that does not exist or is there twice, and on an input with a
/// rate of its own, which says something of it beforehand.
std::vector<Eigen::Index> find_unknown_inputs(const std::string& filter, const DiscreteModel& model,
                                              const std::vector<double>& stated);

}  // namespace beamid::filters
