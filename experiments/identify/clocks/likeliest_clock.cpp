#include "experiments/identify/clocks/likeliest_clock.hpp"

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// W^T W of the unknowns (q), of lags and of growths (terms x p) and of what is left, where the clocks of the
// members are one, and the others right: of the unknowns, of one lag and, of two terms, its growth.
MatrixXd with_one_clock(const MatrixXd& information, const VectorXd& members, Index terms) {
  const Index p = members.size(), last = information.rows() - 1, q = last - 2 * p;
  MatrixXd kept = MatrixXd::Zero(last + 1, q + terms + 1);
  kept.topLeftCorner(q, q).setIdentity();
  for (Index term = 0; term < terms; ++term) kept.col(q + term).segment(q + term * p, p) = members;
  kept(last, q + terms) = 1.0;
  return kept.transpose() * information * kept;
}

}  // namespace

double LikeliestClock::deviation(Index i) const {
  return std::sqrt(step.left_share) * step.deviation[i];
}

LikeliestClocks likeliest_clocks(filters::DiscreteModel& discrete, const VectorXd& initial_state,
                                 const StartDirections& directions, const filters::Measurements& record,
                                 const MatrixXd& outputs) {
  const Index p = outputs.rows();
  std::vector<OwnClock> clocks;
  for (Index i = 0; i < p; ++i) clocks.push_back({i, false, {i}});
  const MatrixXd information =
      clock_information(discrete, initial_state, directions, record, outputs, clocks, true);
  LikeliestClocks best;
  if (!information.allFinite()) return best;
  const auto try_clock = [&](std::optional<Index> output, const VectorXd& members, Index terms,
                             std::optional<LikeliestClock>& likeliest) {
    try {
      LikeliestClock found{output, clock_step(with_one_clock(information, members, terms), terms)};
      const bool is_determined = found.step.lag.allFinite() && (found.step.deviation.array() > 0.0).all();
      if (is_determined && (!likeliest || found.step.left_share < likeliest->step.left_share))
        likeliest = found;
    } catch (const std::runtime_error&) {  // outputs that do not move
    }
  };
  const auto try_both = [&](std::optional<Index> output, const VectorXd& members) {
    try_clock(output, members, 1, best.late);
    try_clock(output, members, 2, best.drifting);
  };
  if (record.inputs.size() > 0) try_both({}, VectorXd::Ones(p));
  for (Index i = 0; i < p && p > 1; ++i) try_both(i, VectorXd::Unit(p, i));
  return best;
}

}  // namespace beamid::experiments
