// Structures and measured modes for tests of updating.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/modal/modal_data.hpp"

namespace beamid::experiments {

Experiment experiment_of(const std::string& toml);

/// Four floors of 12.060 lb on storeys described as 10 lbf/in, sensors on every floor (SCIENCE.md, section 9;
/// github.com/ywang-structures/Structural-Model-Updating).
Experiment four_storeys();
/// Three floors of 5.36 kg (github.com/allumios/os_digital_twin).
Experiment three_storeys();
inline constexpr double lbf_per_in = 175.126835246;  // [N/m]

/// Frequencies without shapes.
ModalData frequencies(const std::vector<double>& frequencies_hz);
inline const std::vector<double> four_frequencies{0.8829, 2.7477, 4.2998, 5.5295};
inline const std::vector<double> three_frequencies{7.203, 20.961, 30.435};

/// The lowest modes of a structure at these values, with shapes at its sensors.
ModalData predicted_data(const Experiment& experiment, const Eigen::VectorXd& values, Eigen::Index count);

/// With normal errors of 0.02 in the shapes' components and of a share of each frequency, stated likewise.
ModalData with_errors(ModalData data, double frequency_share, std::uint64_t seed, std::uint64_t stream);

}  // namespace beamid::experiments
