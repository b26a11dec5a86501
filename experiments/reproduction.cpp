#include "experiments/reproduction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

// Rows of a least squares problem, taken in block by block and kept as their triangular factor.
class RunningQr {
 public:
  explicit RunningQr(Index unknowns, Index block_rows)
      : columns_(unknowns + 1), work_(MatrixXd::Zero(columns_ + block_rows, columns_)) {}

  void add(const MatrixXd& rows, const VectorXd& right_hand_side) {
    if (filled_ + rows.rows() > work_.rows()) compress();
    work_.block(filled_, 0, rows.rows(), columns_ - 1) = rows;
    work_.block(filled_, columns_ - 1, rows.rows(), 1) = right_hand_side;
    filled_ += rows.rows();
  }

  VectorXd solution() {
    compress();
    // Columns of start directions differ by many orders of magnitude: a unit diagonal first.
    const Index k = columns_ - 1;
    const VectorXd scale =
        work_.topLeftCorner(k, k).colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    const MatrixXd factor = work_.topLeftCorner(k, k) * scale.asDiagonal();
    return scale.cwiseProduct(factor.completeOrthogonalDecomposition().solve(work_.col(k).head(k)));
  }

 private:
  void compress() {
    const Eigen::HouseholderQR<MatrixXd> qr(work_.topRows(filled_));
    const Index rows = std::min(filled_, columns_);
    const MatrixXd triangle = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
    work_.setZero();
    work_.topRows(rows) = triangle;
    filled_ = rows;
  }

  Index columns_, filled_ = 0;
  MatrixXd work_;
};

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
  RunningQr equations(k, 64 * p);
  for (Index step = 0; step < samples; ++step) {
    if (record.inputs.size() > 0) input = record.inputs.col(step);
    model.output(x, input, output);
    model.output_jacobian(x, input, sensor);
    forced.col(step) = output;
    read.middleRows(step * p, p).noalias() = sensor * moved;
    if (!read.middleRows(step * p, p).allFinite() || !output.allFinite())
      throw std::runtime_error("the reproduced motion grows beyond all bounds at " +
                               std::to_string(record.time[step]) + " s");
    equations.add(noise.matrixL().solve(read.middleRows(step * p, p)),
                  noise.matrixL().solve(record.outputs.col(step) - output));
    model.move(x, input, next, moved);
    x.swap(next);
  }
  const VectorXd found = equations.solution();

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
