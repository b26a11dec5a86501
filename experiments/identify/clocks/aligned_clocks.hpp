// The lags of channels that have clocks of their own, found with the parameters of a model.
#pragma once

#include <filesystem>

#include "experiments/identify/engine/comparison.hpp"

namespace beamid::experiments {

/// The record on one clock, with the lags that were found.
///
/// At first the channels of the common clock alone are identified (of an input with a clock of its own none:
/// the model stays at its guess), and what that makes of the others is correlated with them, which finds lags
/// of up to a quarter of the record. With those that suit the model best all channels are identified, and the
/// lags take steps of Gauss and Newton (likeliest_clock.hpp) until one moves them by less than a tenth of
/// their deviations.
/// @throws as compare(); std::invalid_argument as own_clocks(), or where no run comes to its end
ComparedRecord aligned_clocks(const Experiment& experiment, ComparedRecord record,
                              const std::filesystem::path& folder, const Progress& progress);

}  // namespace beamid::experiments
