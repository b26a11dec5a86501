#include "experiments/identify/reproduction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/signal/missing_samples.hpp"
#include "filters/information_factor.hpp"
#include "filters/sample_walk.hpp"
#include "filters/whiteness.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

// The least squares solution of rows [A b], kept as their triangular factor.
VectorXd solution(const filters::InformationFactor& equations) {
  // Columns of start directions differ by many orders of magnitude: a unit diagonal first.
  const MatrixXd root = equations.root();
  const Index k = root.cols() - 1;
  const VectorXd scale =
      root.topLeftCorner(k, k).colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const MatrixXd factor = root.topLeftCorner(k, k) * scale.asDiagonal();
  return scale.cwiseProduct(factor.completeOrthogonalDecomposition().solve(root.col(k).head(k)));
}

}  // namespace

void take_misfit(const filters::Measurements& record, Reproduction& motion) {
  motion.residual_deviation = root_mean_squares(record.outputs - motion.outputs);
  const VectorXd share =
      motion.residual_deviation.cwiseQuotient(root_mean_squares(record.outputs).cwiseMax(1e-300));
  constexpr double surely_coloured = 1e-3;
  const double per_channel = 100.0 / std::sqrt(static_cast<double>(share.size()));
  motion.response_error_percent = per_channel * share.norm();
  double coloured = 0.0;
  for (Index i = 0; i < share.size(); ++i) {
    const VectorXd rest = record.outputs.row(i) - motion.outputs.row(i);
    const filters::Whiteness whiteness = filters::whiteness_of(rest);
    // White noise beside a motion takes a part of its own from every correlation.
    if (whiteness.p_value < surely_coloured)
      coloured += share[i] * share[i] * std::min(1.0, whiteness.autocorrelation.cwiseAbs().maxCoeff());
  }
  motion.misfit_percent = per_channel * std::sqrt(coloured);
}

Reproduction reproduce(filters::DiscreteModel& model, const VectorXd& state,
                       const StartDirections& directions, const filters::Measurements& record) {
  const Index samples = record.time.size(), p = record.outputs.rows(), k = directions.motion.cols();
  const Eigen::LLT<MatrixXd> noise(model.output_noise());
  // Everything but the parameters starts at zero and is found.
  VectorXd start = state;
  for (Index i = 0; i < start.size(); ++i)
    if (directions.unknowns.row(i).isZero(0.0)) start[i] = 0.0;

  MatrixXd read(p * samples, k), sensor, moved = directions.motion;
  MatrixXd forced(p, samples), rows(p, k + 1);
  VectorXd output(p);
  filters::InformationFactor equations(k + 1);
  filters::walk_samples(model, record, samples, start, moved,
                        [&](Index step, const auto& x, const auto& input) {
                          model.output(x, input, output);
                          model.output_jacobian(x, input, sensor);
                          forced.col(step) = output;
                          read.middleRows(step * p, p).noalias() = sensor * moved;
                          if (!read.middleRows(step * p, p).allFinite() || !output.allFinite())
                            throw std::runtime_error("the reproduced motion grows beyond all bounds at " +
                                                     std::to_string(record.time[step]) + " s");
                          rows << read.middleRows(step * p, p), record.outputs.col(step) - output;
                          for (Index i = 0; i < p; ++i)
                            if (std::isnan(record.outputs(i, step)))
                              rows.row(i).setZero();  // channels' noises are independent
                          noise.matrixL().solveInPlace(rows);
                          equations.add(rows);
                        });
  const VectorXd found = solution(equations);

  Reproduction result;
  result.initial_state = start + directions.motion * found;
  result.outputs = forced + (read * found).reshaped(p, samples);
  take_misfit(record, result);
  return result;
}

}  // namespace beamid::experiments
