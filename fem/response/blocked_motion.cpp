#include "fem/response/blocked_motion.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

BlockedMotion::BlockedMotion(const ModalBasis& basis, const MatrixXd& loads, double interval,
                             const ModalObservation& observation)
    : step_(basis, loads, interval), leap_(basis, loads, static_cast<double>(length) * interval) {
  const Index r = observation.state.rows(), m = loads.cols(), states = observation.state.cols();
  observed_.resize(length * r, states);
  MatrixXd rows = observation.state;
  for (Index j = 0; j < length; ++j) {
    observed_.middleRows(j * r, r) = rows;
    if (j + 1 < length) rows = step_.apply_to_rows(rows);
  }
  // y_j = F f_j + sum of O A^{j-i} U f_i (0 < i <= j) + O A^{j-i-1} V f_i (i < j)
  const MatrixXd by_from = observed_ * step_.from, by_to = observed_ * step_.to;
  answers_.setZero(length * r, length * m);
  for (Index j = 0; j < length; ++j)
    for (Index i = 0; i <= j; ++i) {
      auto answer = answers_.block(j * r, i * m, r, m);
      if (i == j) answer += observation.input;
      if (i > 0) answer += by_to.middleRows((j - i) * r, r);
      if (i < j) answer += by_from.middleRows((j - i - 1) * r, r);
    }
  // x_L = A^L x + sum of A^{L-i} U f_i (0 < i <= L) + A^{L-i-1} V f_i (i < L)
  pushed_.setZero(states, length * m);
  MatrixXd from = step_.from, to = step_.to;
  for (Index i = length; i-- > 0;) {
    pushed_.middleCols(i * m, m) += from;
    if (i == 0) break;
    to = step_.apply(to);
    pushed_.middleCols(i * m, m) += to;
    from = step_.apply(from);
  }
}

MatrixXd BlockedMotion::advance(VectorXd& state, const MatrixXd& inputs, const VectorXd& after) {
  const Index blocks = inputs.cols(), m = after.size();
  starts_.resize(state.size(), blocks);
  MatrixXd pushes;
  if (m > 0) pushes.noalias() = pushed_ * inputs;
  for (Index block = 0; block < blocks; ++block) {
    starts_.col(block) = state;
    state = leap_.apply(state);
    if (m > 0)
      state += pushes.col(block) + step_.to * (block + 1 < blocks ? inputs.col(block + 1).head(m) : after);
  }
  MatrixXd observations = observed_ * starts_;
  if (m > 0) observations.noalias() += answers_ * inputs;
  return observations;
}

}  // namespace beamid::fem
