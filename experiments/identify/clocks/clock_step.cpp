#include "experiments/identify/clocks/clock_step.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "experiments/signal/cubic_spline.hpp"
#include "filters/information_factor.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// y'(t) of every row, by its spline.
MatrixXd slopes(const VectorXd& time, const MatrixXd& outputs) {
  const double aside = 0.05 * (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  MatrixXd result(outputs.rows(), outputs.cols());
  for (Index i = 0; i < outputs.rows(); ++i) {
    const CubicSpline motion(time, outputs.row(i).transpose());
    result.row(i) =
        ((motion(VectorXd(time.array() + aside)) - motion(VectorXd(time.array() - aside))) / (2.0 * aside))
            .transpose();
  }
  return result;
}

}  // namespace

MatrixXd clock_information(filters::DiscreteModel& discrete, const VectorXd& initial_state,
                           const StartDirections& directions, const filters::Measurements& record,
                           const MatrixXd& outputs, const std::vector<OwnClock>& clocks, bool grow) {
  const MatrixXd all = directions.all(), moving = slopes(record.time, outputs);
  const auto g = static_cast<Index>(clocks.size());
  const Index starts = directions.motion.cols(), q = directions.unknowns.cols(),
              columns = starts + q + (grow ? 2 : 1) * g + 1;
  const Eigen::LLT<MatrixXd> noise(discrete.output_noise());
  filters::InformationFactor factor(columns);
  MatrixXd moved = all, sensor, rows(outputs.rows(), columns);
  VectorXd state = initial_state, next, input;
  for (Index k = 0; k < outputs.cols(); ++k) {
    if (record.inputs.size() > 0) input = record.inputs.col(k);
    discrete.output_jacobian(state, input, sensor);
    rows.setZero();
    rows.leftCols(starts + q).noalias() = sensor * moved;
    for (Index j = 0; j < g; ++j) {
      const OwnClock& clock = clocks[static_cast<std::size_t>(j)];
      for (const Index i : clock.outputs) rows(i, starts + q + j) = (clock.input ? 1.0 : -1.0) * moving(i, k);
    }
    if (grow)
      rows.middleCols(starts + q + g, g) = (record.time[k] - record.time[0]) * rows.middleCols(starts + q, g);
    rows.rightCols<1>() = record.outputs.col(k) - outputs.col(k);
    for (Index i = 0; i < rows.rows(); ++i)
      if (!std::isfinite(record.outputs(i, k))) rows.row(i).setZero();
    factor.add(noise.matrixL().solve(rows));
    if (k + 1 == outputs.cols()) break;
    discrete.move(state, input, next, moved);
    state.swap(next);
  }
  factor.add(MatrixXd::Identity(columns, columns).middleRows(starts, q));
  std::vector<Index> start(static_cast<std::size_t>(starts));
  std::iota(start.begin(), start.end(), Index{0});
  return factor.without(start).information();
}

ClockStep clock_step(const MatrixXd& information, Index clocks) {
  const Index g = clocks, q = information.rows() - g - 1;
  // To a unit diagonal: seconds beside shares of deviations.
  const VectorXd scale = information.diagonal().head(q + g).cwiseSqrt();
  if (!(scale.tail(g).array() > 0.0).all())
    throw std::runtime_error("a channel with a clock of its own does not move: its lag cannot be determined");
  const MatrixXd scaled = scale.cwiseInverse().asDiagonal() * information.topLeftCorner(q + g, q + g) *
                          scale.cwiseInverse().asDiagonal();
  const MatrixXd covariance = Eigen::LDLT<MatrixXd>(scaled).solve(MatrixXd::Identity(q + g, q + g));
  const MatrixXd known = Eigen::LDLT<MatrixXd>(scaled.topLeftCorner(q, q)).solve(MatrixXd::Identity(q, q));
  const VectorXd right = information.col(q + g).head(q + g).cwiseQuotient(scale);
  const VectorXd with = covariance * right, without = known * right.head(q);
  ClockStep step;
  step.lag = with.tail(g).cwiseQuotient(scale.tail(g));
  step.deviation = covariance.diagonal().tail(g).cwiseMax(0.0).cwiseSqrt().cwiseQuotient(scale.tail(g));
  step.widening = (covariance.diagonal().head(q).array() / known.diagonal().array()).max(1.0).sqrt();
  step.shift = (with.head(q) - without).cwiseQuotient(known.diagonal().cwiseSqrt());
  const double all = information(q + g, q + g), left = all - right.dot(with),
               before = all - right.head(q).dot(without);
  if (before > 0.0) step.left_share = std::clamp(left / before, 0.0, 1.0);
  return step;
}

}  // namespace beamid::experiments
