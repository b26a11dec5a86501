#include "experiments/identify/reproduction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "filters/information_factor.hpp"

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

Reproduction reproduce(filters::DiscreteModel& model, const VectorXd& state,
                       const StartDirections& directions, const filters::Measurements& record) {
  const Index samples = record.time.size(), p = record.outputs.rows(), k = directions.motion.cols();
  const Eigen::LLT<MatrixXd> noise(model.output_noise());
  // Everything but the parameters starts at zero and is found.
  VectorXd start = state;
  for (Index i = 0; i < start.size(); ++i)
    if (directions.unknowns.row(i).isZero(0.0)) start[i] = 0.0;

  MatrixXd read(p * samples, k), sensor, moved = directions.motion;
  MatrixXd forced(p, samples);
  VectorXd x = start, next, output(p), input;
  filters::InformationFactor equations(k + 1);
  MatrixXd rows(p, k + 1);
  for (Index step = 0; step < samples; ++step) {
    if (record.inputs.size() > 0) input = record.inputs.col(step);
    model.output(x, input, output);
    model.output_jacobian(x, input, sensor);
    forced.col(step) = output;
    read.middleRows(step * p, p).noalias() = sensor * moved;
    if (!read.middleRows(step * p, p).allFinite() || !output.allFinite())
      throw std::runtime_error("the reproduced motion grows beyond all bounds at " +
                               std::to_string(record.time[step]) + " s");
    rows << read.middleRows(step * p, p), record.outputs.col(step) - output;
    noise.matrixL().solveInPlace(rows);
    equations.add(rows);
    model.move(x, input, next, moved);
    x.swap(next);
  }
  const VectorXd found = solution(equations);

  Reproduction result;
  result.initial_state = start + directions.motion * found;
  result.outputs = forced + (read * found).reshaped(p, samples);
  const MatrixXd left = record.outputs - result.outputs;
  result.residual_deviation = (left.rowwise().squaredNorm() / static_cast<double>(samples)).cwiseSqrt();
  const VectorXd size = record.outputs.rowwise().norm();
  const VectorXd share = left.rowwise().norm().cwiseQuotient(size.cwiseMax(1e-300));
  result.response_error_percent = 100.0 * share.norm() / std::sqrt(static_cast<double>(p));
  return result;
}

}  // namespace beamid::experiments
