// Models of a record by other descriptions than its own.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <utility>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/driven/description_faults.hpp"
#include "experiments/identify/driven/driven_part.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// What a score is above where chance is no reason [standard deviations].
inline constexpr double sure_score = 5.0;

/// The model of another structure, experiment or record. What it is made from outlives it.
class OtherModels {
 public:
  OtherModels(const Experiment& experiment, const Record& record, const Choice& reduction,
              const std::filesystem::path& folder)
      : experiment_(experiment), record_(record), reduction_(reduction), folder_(folder) {}

  /// @throws std::exception where there is no such structure, or no motion of it
  JointModel of(const fem::Structure& structure) const {
    Experiment other = experiment_;
    other.structure = structure;
    return of(other);
  }
  JointModel of(const Experiment& other) const { return made(other, record_); }
  JointModel of(const Record& other) const { return made(experiment_, other); }

 private:
  const Experiment& experiment_;
  const Record& record_;
  const Choice& reduction_;
  const std::filesystem::path& folder_;

  JointModel made(const Experiment& experiment, const Record& record) const {
    const ModelSetting setting = model_setting(experiment, record, reduction_, folder_);
    return std::move(*model_registry().make(experiment.model.name, experiment.model.options, setting));
  }
};

/// Adds what another damping of the same structure would explain (damping_faults.cpp): ratios of their own of
/// the modes where one is asked of all, or where dashpots sit in the storeys; dashpots in the storeys of a
/// chain where its modes have ratios.
/// @param theta of the problem's unknowns, in the model's coordinates (q)
void add_other_damping(const DrivenProblem& problem, const OtherModels& models, const Experiment& experiment,
                       const LineScores& left, const Eigen::VectorXd& theta,
                       std::vector<DescriptionFault>& faults);

}  // namespace beamid::experiments
