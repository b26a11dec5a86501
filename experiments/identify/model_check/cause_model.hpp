// The modes of a structure as functions of changes that would explain what was measured.
#pragma once

#include <vector>

#include "experiments/identify/model_check/candidates.hpp"
#include "experiments/identify/update/modal_slopes.hpp"

namespace beamid::experiments {

/// f(x) and S phi(x) of the changed structure, assembled anew for every x: changes need not be small, nor the
/// matrices affine in them. Derivatives are those of update, lambda' = phi^T (K' - lambda M') phi [fox1968],
/// K' and M' from differences of assemblies: exact to rounding where the matrices are of second degree in x.
class CauseModel final : public ModesOfParameters {
 public:
  /// @param points sensors; of a beam they move with its length
  /// @param causes q; their changes are the parameters, 0 as described, within what is possible
  CauseModel(fem::Structure structure, int elements, std::vector<fem::Point> points,
             std::vector<Candidate> causes, Eigen::Index count);

  PredictedModes at(const Eigen::VectorXd& changes, bool slopes) const override;
  const AskedParameters& asked() const override { return asked_; }
  Eigen::Index size() const override { return described_.size(); }
  Eigen::Index modes() const override { return count_; }
  bool dense() const override { return false; }
  const fem::StructuralSystem& described() const { return described_; }

 private:
  fem::Structure structure_;
  int elements_;
  std::vector<fem::Point> points_;
  std::vector<Candidate> causes_;
  AskedParameters asked_;
  fem::StructuralSystem described_;
  Eigen::Index count_;

  fem::StructuralSystem assembled(const Eigen::VectorXd& changes) const;
  /// Of n coordinates, of which a support that gives way has more.
  MatrixSlope slope(const Eigen::VectorXd& changes, Eigen::Index cause, Eigen::Index n) const;
};

}  // namespace beamid::experiments
