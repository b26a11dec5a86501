// A registered model of one coordinate fitted to all samples of a decay.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/identify/backbone/record_fit.hpp"

namespace beamid::experiments {

/// Quantities of a model with the values that its fit begins with, stiffness and damping first.
using ModelStart = std::vector<std::pair<std::string, double>>;

/// By filters::estimate_batch in the fine steps of the samples (Runge-Kutta), from several starts of its
/// unknowns; the best of them.
/// @param noise standard deviation of a sample
/// @param motion [x, x'] at the first sample, the beginning of each
RecordFit registered_fit(const std::string& name, const DecaySamples& samples, double mass, double noise,
                         const Eigen::Vector2d& motion, double offset, const std::vector<ModelStart>& starts);

}  // namespace beamid::experiments
