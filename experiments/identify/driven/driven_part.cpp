#include "experiments/identify/driven/driven_part.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;

// What a converter that holds or joins samples by lines does to a frequency.
Complex path_gain(InputPath path, double omega, double interval) {
  if (path == InputPath::band_limited) return 1.0;
  const double half = 0.5 * omega * interval, sinc = std::sin(half) / half;
  return path == InputPath::linear ? Complex(sinc * sinc) : sinc * std::exp(Complex(0.0, -half));
}

}  // namespace

MatrixXcd part_motion(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part,
                      const VectorXd& difference) {
  MatrixXcd inputs = part.inputs;
  for (Index k = 0; k < part.omega.size(); ++k)
    inputs.col(k) *= path_gain(problem.path, part.omega[k], part.interval);
  return problem.weights.asDiagonal() * response.motion(part.omega, part.interval, inputs, difference);
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
  const VectorXd all = line_rows(read.reshaped());
  MatrixXd columns = line_rows(added);
  const VectorXd scale = columns.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
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
  rows.applyOnTheLeft(ends.householderQ().transpose());
  rows.head(ends.rank()).setZero();
  rows.applyOnTheLeft(ends.householderQ());
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
    for (std::size_t i = 0; i < parts.size(); ++i)
      found[i].col(j) = parts[i].change_to(problem_, moved, problem_.parts[i]) / step;
  }
  return found;
}

}  // namespace beamid::experiments
