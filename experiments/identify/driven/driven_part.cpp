#include "experiments/identify/driven/driven_part.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;
using std::numbers::pi;

// What a converter that holds or joins samples by lines does to a frequency.
Complex path_gain(InputPath path, double omega, double interval) {
  if (path == InputPath::band_limited) return 1.0;
  const double half = 0.5 * omega * interval, sinc = std::sin(half) / half;
  return path == InputPath::linear ? Complex(sinc * sinc) : sinc * std::exp(Complex(0.0, -half));
}

// L_k^-1 before the rows of every line, 1 + W G_k R_u G_k^H W = L_k L_k^H. @param read, added (p L x ...)
void whiten(const std::vector<MatrixXcd>& by_inputs, Index lines, MatrixXcd& read, MatrixXcd& added) {
  const Index p = read.rows() / lines;
  for (Index k = 0; k < lines; ++k) {
    MatrixXcd covariance = MatrixXcd::Identity(p, p);
    for (const MatrixXcd& one : by_inputs) covariance.noalias() += one.col(k) * one.col(k).adjoint();
    const Eigen::LLT<MatrixXcd> factor(covariance);
    for (MatrixXcd* rows : {&read, &added}) {
      auto block = rows->middleRows(k * p, p);
      factor.matrixL().solveInPlace(block);
    }
  }
}

}  // namespace

MatrixXcd part_motion(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part,
                      const VectorXd& difference) {
  MatrixXcd inputs = part.inputs;
  for (Index k = 0; k < part.omega.size(); ++k)
    inputs.col(k) *= path_gain(problem.path, part.omega[k], part.interval);
  return problem.weights.asDiagonal() * response.motion(part.omega, part.interval, inputs, difference);
}

std::vector<MatrixXcd> motions_by_inputs(const DrivenProblem& problem, const LinearResponse& response,
                                         const RecordLines& part, const VectorXd& sizes) {
  std::vector<MatrixXcd> found;
  const VectorXd at_rest = VectorXd::Zero(response.motion_size());
  for (Index j = 0; j < part.inputs.rows(); ++j) {
    RecordLines unit = part;
    unit.inputs.setZero();
    unit.inputs.row(j).setConstant(sizes[j]);
    found.push_back(part_motion(problem, response, unit, at_rest));
  }
  return found;
}

PartAt::PartAt(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part) {
  const Index p = part.outputs.rows(), lines = part.omega.size(), l = response.motion_size();
  driven = part_motion(problem, response, part, VectorXd::Zero(l));
  MatrixXcd added = MatrixXcd::Zero(p * lines, l + 2 * p);
  added.leftCols(l) = response.free_motions(part.omega, part.interval);
  for (Index k = 0; k < lines; ++k)
    for (Index i = 0; i < p; ++i) {
      added.row(k * p + i).head(l) *= problem.weights[i];
      added(k * p + i, l + i) = 1.0;
      added(k * p + i, l + p + i) = Complex(0.0, std::sin(part.omega[k] * part.interval));
    }
  MatrixXcd read = part.outputs;
  read = problem.weights.asDiagonal() * read - driven;
  read.resize(p * lines, 1);
  if (problem.input_noise.size() > 0)
    whiten(motions_by_inputs(problem, response, part, problem.input_noise), lines, read, added);
  const VectorXd all = line_rows(read);
  columns = line_rows(added);
  VectorXd scale = columns.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  // What dies out or turns within a sample is nothing that a record holds: its amplitudes would be rounding.
  for (Index j = 0; j < l; ++j)
    if (std::abs(response.poles()[j]) * part.interval > pi) scale[j] = 0.0;
  columns = columns * scale.asDiagonal();
  ends.setThreshold(1e-10);
  ends.compute(columns);
  const VectorXd scaled = ends.solve(all);
  left = all - columns * scaled;
  difference = response.difference((scale.head(l).asDiagonal() * scaled.head(l)));
  moved = part_motion(problem, response, part, difference);
}

RecordLines thinned(const RecordLines& part, Index stride) {
  RecordLines found = part;
  const auto lines = Eigen::seqN(stride / 2, part.omega.size() / stride, stride);
  found.omega = part.omega(lines);
  found.outputs = part.outputs(Eigen::all, lines);
  found.inputs = part.inputs(Eigen::all, lines);
  return found;
}

void PartAt::project(VectorXd& rows) const {
  rows -= columns * ends.solve(rows);
}

VectorXd PartAt::change_to(const DrivenProblem& problem, const LinearResponse& other,
                           const RecordLines& part) const {
  if (other.motion_size() != difference.size()) throw std::runtime_error("another number of coordinates");
  const MatrixXcd change = part_motion(problem, other, part, difference) - moved;
  VectorXd rows = line_rows(change.reshaped());
  project(rows);
  return rows;
}

DrivenMotion::DrivenMotion(const DrivenProblem& problem)
    : problem_(problem), motion_(dynamic_cast<const filters::LinearMotion&>(*problem.model->motion)) {
  const MatrixXd& known = problem.prior.covariance;
  prior_ = known.llt().solve(MatrixXd::Identity(known.rows(), known.cols()));
}

LinearResponse DrivenMotion::response(const VectorXd& theta) const {
  constexpr double growth = 1e-9;
  if (!theta.allFinite()) throw std::runtime_error("the unknowns are not finite");
  LinearResponse found(motion_, state_of_unknowns(*problem_.model, theta));
  const VectorXcd& poles = found.poles();
  if ((poles.array().real() > growth * poles.cwiseAbs().maxCoeff()).any())
    throw std::runtime_error("a motion of the model grows at these unknowns");
  return found;
}

std::vector<PartAt> DrivenMotion::at(const VectorXd& theta) const {
  const LinearResponse there = response(theta);
  std::vector<PartAt> found;
  for (const RecordLines& part : problem_.parts) found.emplace_back(problem_, there, part);
  return found;
}

std::vector<PartAt> DrivenMotion::tried_at(const VectorXd& theta) const {
  try {
    std::vector<PartAt> found = at(theta);
    if (std::isfinite(cost(found, theta))) return found;
  } catch (const std::runtime_error&) {  // no motion there
  }
  return {};
}

double DrivenMotion::cost(const std::vector<PartAt>& parts, const VectorXd& theta) const {
  double sum = off(theta).dot(prior_ * off(theta));
  for (const PartAt& part : parts) sum += part.left.squaredNorm();
  return sum;
}

std::vector<MatrixXd> DrivenMotion::slopes(const std::vector<PartAt>& parts, const VectorXd& theta) const {
  constexpr double share = 1e-4;  // of the deviations known beforehand
  const Index q = theta.size();
  std::vector<MatrixXd> found;
  for (const PartAt& part : parts) found.emplace_back(part.left.size(), q);
  for (Index j = 0; j < q; ++j) {
    const double step = share * std::sqrt(problem_.prior.covariance(j, j));
    const LinearResponse moved = response(theta + step * VectorXd::Unit(q, j));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const RecordLines& part = problem_.parts[i];
      // L_k moves with the unknowns, too.
      found[i].col(j) = problem_.input_noise.size() > 0 ? parts[i].left - PartAt(problem_, moved, part).left
                                                        : parts[i].change_to(problem_, moved, part);
      found[i].col(j) /= step;
    }
  }
  return found;
}

LineScores::LineScores(const DrivenProblem& problem, const VectorXd& theta)
    : problem_(problem),
      theta_(theta),
      motion_(problem),
      response_(motion_.response(theta)),
      parts_(motion_.at(theta)),
      slopes_(motion_.slopes(parts_, theta).front()),
      normal_(slopes_.transpose() * slopes_),
      at_once_(left() - slopes_ * normal_.solve(slopes_.transpose() * left())) {}

VectorXd LineScores::left_of(const JointModel& model) const {
  const LinearResponse there(dynamic_cast<const filters::LinearMotion&>(*model.motion),
                             state_of_unknowns(model, theta_));
  return PartAt(problem_, there, problem_.parts.front()).left;
}

VectorXd LineScores::slope_by(const std::function<void(DrivenProblem& other, double step)>& change) const {
  constexpr double step = 1e-4;
  DrivenProblem other = problem_;
  change(other, step);
  return (left() - PartAt(other, response_, other.parts.front()).left) / step;
}

VectorXd LineScores::change_of(const JointModel& described, const JointModel& other) const {
  VectorXd change = left_of(described) - left_of(other);
  part().project(change);
  return change;
}

VectorXd LineScores::gain_of(Index channel) const {
  return slope_by([channel](DrivenProblem& other, double step) {
    other.weights[channel] *= 1.0 + step;
    other.parts.front().outputs.row(channel) /= 1.0 + step;
  });
}

VectorXd LineScores::gain_of_inputs() const {
  return slope_by([](DrivenProblem& other, double step) {
    other.parts.front().inputs *= 1.0 + step;
    other.input_noise *= 1.0 + step;
  });
}

VectorXd LineScores::lag_of(std::optional<Index> channel) const {
  return slope_by([channel](DrivenProblem& other, double step) {
    RecordLines& part = other.parts.front();
    const VectorXcd turned = (Complex(0.0, step * part.interval) * part.omega.cast<Complex>()).array().exp();
    if (channel)
      part.outputs.row(*channel).array() *= turned.transpose().array();
    else
      part.inputs.array().rowwise() *= turned.transpose().array();
  });
}

namespace {

/// sum_k a_k a_k^T (r_k / (1 - h_k)^e)^2 over the lines, a_k the rows of orthonormal axes and h_k = |a_k|^2.
/// @param power e: 1/2 of what noise of one level leaves, 1 on the safe side [mackinnon1985]
MatrixXd variance_along(const MatrixXd& axes, const VectorXd& rest, double power) {
  const Index half = axes.rows() / 2;
  MatrixXd variance = MatrixXd::Zero(axes.cols(), axes.cols());
  for (Index k = 0; k < half; ++k) {
    const double weight = axes.row(k).squaredNorm() + axes.row(k + half).squaredNorm();
    const VectorXd line = (axes.row(k) * rest[k] + axes.row(k + half) * rest[k + half]) /
                          std::pow(std::max(1e-3, 1.0 - weight), power);
    variance += line * line.transpose();
  }
  return variance;
}

}  // namespace

std::optional<LineScores::Score> LineScores::score(const VectorXd& direction, double collinear) const {
  const VectorXd coefficients = normal_.solve(slopes_.transpose() * direction);
  const VectorXd own = direction - slopes_ * coefficients;
  const double squares = own.squaredNorm();
  if (!(squares > collinear * collinear * direction.squaredNorm())) return {};
  const double size = std::sqrt(squares);
  const VectorXd axis = own / size;
  // Of the change itself, by what is left with it: lines of their own noise, one that weighs much by more.
  const double sum = axis.dot(at_once_), change = sum / size,
               spread = std::sqrt(variance_along(axis, at_once_ - sum * axis, 1.0)(0, 0));
  return Score{change, spread / size, std::abs(sum) / std::max(spread, 1e-300),
               sum * sum / std::max(left().squaredNorm(), 1e-300), -change * coefficients};
}

VectorXd LineScores::deviations() const {
  const Eigen::HouseholderQR<MatrixXd> factors(slopes_);
  const Index q = slopes_.cols();
  const MatrixXd axes = factors.householderQ() * MatrixXd::Identity(slopes_.rows(), q),
                 root = factors.matrixQR().topRows(q).triangularView<Eigen::Upper>().solve(
                     MatrixXd::Identity(q, q));
  return (root * variance_along(axes, at_once_, 0.5) * root.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

double LineScores::together(const MatrixXd& directions) const {
  const MatrixXd own = directions - slopes_ * normal_.solve(slopes_.transpose() * directions);
  Eigen::ColPivHouseholderQR<MatrixXd> factors(own.rows(), own.cols());
  factors.setThreshold(1e-3);
  factors.compute(own);
  const MatrixXd axes = factors.householderQ() * MatrixXd::Identity(own.rows(), factors.rank());
  const VectorXd sum = axes.transpose() * at_once_;
  return sum.dot(variance_along(axes, at_once_ - axes * sum, 1.0).ldlt().solve(sum));
}

}  // namespace beamid::experiments
