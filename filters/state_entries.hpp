// Entries of a state that an option names.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace beamid::filters {

/// @param what begins the message: "dual_ekf: parameters" @param size of the state
/// @return the entries in increasing order
/// @throws std::invalid_argument where one is no whole number below `size`, or there twice.
std::vector<Eigen::Index> state_entries(const std::string& what, const std::vector<double>& stated,
                                        std::size_t size);

}  // namespace beamid::filters
