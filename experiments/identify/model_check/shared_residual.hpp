// The modes of all structures that are checked, as one residual of the changes that they share.
#pragma once

#include <memory>
#include <vector>

#include "experiments/identify/model_check/candidates.hpp"
#include "experiments/identify/model_check/model_check.hpp"
#include "experiments/identify/update/modal_model.hpp"
#include "experiments/identify/update/modal_residual.hpp"

namespace beamid::experiments {

// What one change, or two together, make of the differences.

/// update (update/updating.hpp) of the changes alone: the same residual, search, intervals and limits. An
/// interval does not leave what is possible; of one change that is held by a bound it begins there.
Explanation explain(const ModelCheck& check, const std::vector<std::size_t>& which);

/// Of the structures as described, without their shapes' scales: chi^2, and numbers that are independent.
std::pair<double, Eigen::Index> described_fit(const ModelCheck& check);

// The modes of a structure as functions of changes that would explain what was measured.

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

/// The residual of update for each structure that has modes, one above the other.
class SharedResidual final : public FitResidual {
 public:
  /// @param which candidates (q); none: the structures as described
  SharedResidual(const ModelCheck& check, const std::vector<std::size_t>& which);

  Value at(const Eigen::VectorXd& x, bool jacobian) const override;
  Eigen::Index independent(const Value& value) const override;
  const ModesOfParameters& model() const override { return *models_.front(); }
  const SearchSpace& space() const override { return space_; }

  /// ln(identified / predicted) of the checked modes, in their order (n).
  Eigen::VectorXd left(const Value& value) const;
  /// d ln f / dx of the same (n x q).
  Eigen::MatrixXd effect(const Value& value) const;

 private:
  std::vector<std::unique_ptr<const CauseModel>> models_;
  SearchSpace space_;
  std::vector<ModalResidual> parts_;
};

/// Sensors of a structure's shapes; one natural point where no shapes are compared.
std::vector<fem::Point> points_of_shapes(const CheckedStructure& structure);

/// As update takes it: the shape, where it is one at so many points, a real one, the number that is known.
MeasuredMode as_measured(const ObservedMode& mode, std::size_t points, std::optional<int> number);

}  // namespace beamid::experiments
