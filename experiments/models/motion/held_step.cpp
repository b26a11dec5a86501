#include "experiments/models/motion/held_step.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

HeldStep::HeldStep(RationalStep& step, const SecondOrderForm& form,
                   const std::vector<SecondOrderForm>& slopes, Index powers)
    : moving_(2 * form.stiffness.rows()), powers_(powers) {
  const Index all = columns(form, powers), q = static_cast<Index>(slopes.size());
  value_.resize(moving_, all);
  slope_.resize(moving_ * q, all);
  joined_.resize(all);
  MatrixXd along(moving_, q);
  VectorXd state = VectorXd::Zero(moving_), next(moving_);
  const auto keep = [&](Index column) {
    step.apply(state, next);
    value_.col(column) = next;
    step.tangent_by_unknowns(state, slopes, along);
    slope_.col(column) = along.reshaped();
  };
  step.set(form, {});
  for (Index i = 0; i < moving_; ++i) {
    state[i] = 1.0;
    keep(i);
    state[i] = 0.0;
  }
  MatrixXd chain = MatrixXd::Zero(form.inputs.cols(), powers);
  for (Index i = 0; i < chain.size(); ++i) {
    chain.reshaped()[i] = 1.0;
    step.set(form, chain);
    keep(moving_ + i);
    chain.reshaped()[i] = 0.0;
  }
}

void HeldStep::step(const VectorXd& state, const MatrixXd& chain, VectorXd& next,
                    Eigen::Ref<MatrixXd> tangent, Eigen::Ref<MatrixXd> by_unknowns) {
  joined_.head(moving_) = state.head(moving_);
  joined_.tail(chain.size()) = chain.reshaped();
  next.head(moving_).noalias() = value_ * joined_;
  tangent = value_.leftCols(moving_);
  sloped_.noalias() = slope_ * joined_;
  by_unknowns = sloped_.reshaped(moving_, by_unknowns.cols());
}

}  // namespace beamid::experiments
