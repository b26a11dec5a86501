#include "experiments/identify/clocks/likeliest_lag.hpp"

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Of the clocks of p outputs, those that a hypothesis makes one: W^T W with their columns added up.
MatrixXd with_one_clock(const MatrixXd& information, const VectorXd& members) {
  const Index p = members.size(), q = information.rows() - p - 1;
  MatrixXd kept = MatrixXd::Zero(q + p + 1, q + 2);
  kept.topLeftCorner(q, q).setIdentity();
  kept.col(q).segment(q, p) = members;
  kept(q + p, q + 1) = 1.0;
  return kept.transpose() * information * kept;
}

}  // namespace

double LikeliestLag::deviation() const {
  return std::sqrt(step.left_share) * step.deviation[0];
}

std::optional<LikeliestLag> likeliest_lag(filters::DiscreteModel& discrete, const VectorXd& initial_state,
                                          const StartDirections& directions,
                                          const filters::Measurements& record, const MatrixXd& outputs) {
  const Index p = outputs.rows();
  std::vector<OwnClock> clocks;
  for (Index i = 0; i < p; ++i) clocks.push_back({i, false, {i}});
  const MatrixXd information =
      clock_information(discrete, initial_state, directions, record, outputs, clocks);
  if (!information.allFinite()) return {};
  std::optional<LikeliestLag> best;
  const auto try_clock = [&](std::optional<Index> output, const VectorXd& members) {
    try {
      LikeliestLag found{output, clock_step(with_one_clock(information, members), 1)};
      if (std::isfinite(found.lag()) && (!best || found.step.left_share < best->step.left_share))
        best = found;
    } catch (const std::runtime_error&) {  // outputs that do not move
    }
  };
  try_clock({}, VectorXd::Ones(p));
  for (Index i = 0; i < p && p > 1; ++i) try_clock(i, VectorXd::Unit(p, i));
  return best;
}

}  // namespace beamid::experiments
