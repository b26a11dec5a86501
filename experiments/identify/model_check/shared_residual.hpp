// The modes of all structures that are checked, as one residual of the changes that they share.
#pragma once

#include <memory>
#include <vector>

#include "experiments/identify/model_check/cause_model.hpp"
#include "experiments/identify/model_check/model_check.hpp"
#include "experiments/identify/update/modal_residual.hpp"

namespace beamid::experiments {

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
