// The model `beam` and its state, for its tests.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "experiments/models/joint_model.hpp"
#include "tests/experiments/models/beam_setting.hpp"

namespace beamid::experiments {

std::unique_ptr<JointModel> beam_model(const ModelSetting& setting, const filters::Options& options = {});

/// At rest, the unknowns at their guess.
Eigen::VectorXd state_at_guess(const JointModel& model);

void set_unknown(const JointModel& model, Eigen::VectorXd& state, std::size_t j, double value);

/// Eigenvalues of the motion above the real axis, by frequency.
std::vector<std::complex<double>> upper_eigenvalues(const JointModel& model, const Eigen::VectorXd& state);

/// Every kind of sensor, two forces and the base, all parameters that the model knows.
ModelSetting rich_beam_setting();

}  // namespace beamid::experiments
