// The constants of a sensing model: where the likelihood of the record is largest.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/identify/sensing/sensing.hpp"
#include "experiments/identify/sensing/sensing_model.hpp"

namespace beamid::experiments {

/// What a SensingModel is made from.
struct SensingSetting {
  const Experiment& experiment;
  const SensingRecord& record;
  const Choice& reduction;
  const std::filesystem::path& folder;
};

/// The constants: theta, and its covariance.
struct FoundConstants {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
};

/// Searched from several places; what has not converged is said in the study, with its reason.
/// @param model in: as guessed; out: as the constants were found in
/// @param given physical values, which nothing is to be found of
FoundConstants find_constants(const SensingSetting& setting, std::unique_ptr<SensingModel>& model,
                              const std::optional<Eigen::VectorXd>& given, SensingStudy& study);

}  // namespace beamid::experiments
