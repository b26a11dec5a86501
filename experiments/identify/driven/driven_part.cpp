#include "experiments/identify/driven/driven_part.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiments/signal/in_double.hpp"
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

// W G_k of every input by itself, times its size (p x L each).
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
  MatrixXd columns = line_rows(added);
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

namespace {

/// Lines from..to-1 of one band, a third of an octave wide and of eight lines at least.
std::vector<Index> band_edges(const VectorXd& omega) {
  constexpr Index fewest = 8;
  const double width = std::cbrt(2.0);
  std::vector<Index> edges{0};
  for (Index k = 1; k < omega.size(); ++k)
    if (k - edges.back() >= fewest && omega[k] > width * omega[edges.back()]) edges.push_back(k);
  if (omega.size() - edges.back() < fewest && edges.size() > 1) edges.pop_back();
  edges.push_back(omega.size());
  return edges;
}

/// The residual as lines again (p x L).
MatrixXcd lines_left(const PartAt& at, Index channels) {
  const Index rows = at.left.size() / 2;
  MatrixXcd lines(channels, rows / channels);
  lines.reshaped() = at.left.head(rows) + Complex(0.0, 1.0) * at.left.tail(rows);
  return lines;
}

/// -ln of the likelihood of one band's lines, whose channels have the variances `noise` beside `share` of
/// what the inputs make.
double band_cost(const MatrixXcd& left, const std::vector<MatrixXcd>& by_inputs, Index from, Index to,
                 const VectorXd& noise, double share) {
  double cost = 0.0;
  MatrixXcd covariance;
  for (Index k = from; k < to; ++k) {
    covariance = noise.cast<Complex>().asDiagonal();
    for (const MatrixXcd& one : by_inputs)
      covariance.noalias() += share * (one.col(k) * one.col(k).adjoint());
    const Eigen::LLT<MatrixXcd> factor(covariance);
    cost += 2.0 * factor.matrixLLT().diagonal().real().array().log().sum() +
            factor.matrixL().solve(left.col(k)).squaredNorm();
  }
  return cost;
}

}  // namespace

double input_noise_gain(const DrivenProblem& problem, const VectorXd& theta, const VectorXd& sizes) {
  constexpr double least_share = 1e-8, finer = 2.0,
                   floor = 0.05;  // of the inputs' squares; of the residual's
  const DrivenMotion motion(problem);
  const LinearResponse response = motion.response(theta);
  const RecordLines& part = problem.parts.front();
  constexpr double enough_width = 5.0;  // of all resonances together, in lines
  const double duration = part.interval * static_cast<double>(part.samples);
  double width = 0.0;
  for (const Complex pole : response.poles())
    if (pole.imag() > 0.0 && pole.imag() < part.omega[part.omega.size() - 1])
      width -= pole.real() / pi * duration;
  if (width < enough_width) return std::numeric_limits<double>::infinity();
  const MatrixXcd left = lines_left(PartAt(problem, response, part), part.outputs.rows());
  const std::vector<MatrixXcd> by_inputs = motions_by_inputs(problem, response, part, sizes);
  const std::vector<Index> edges = band_edges(part.omega);
  const auto cost = [&](double share) {
    double sum = 0.0;
    for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
      const auto band = Eigen::seq(edges[b], edges[b + 1] - 1);
      const VectorXd squares = left(Eigen::all, band).cwiseAbs2().rowwise().mean().cwiseMax(1e-300);
      VectorXd noise = squares;
      for (const MatrixXcd& one : by_inputs)
        noise -= share * one(Eigen::all, band).cwiseAbs2().rowwise().mean();
      sum += band_cost(left, by_inputs, edges[b], edges[b + 1], noise.cwiseMax(floor * squares), share);
    }
    return sum;
  };
  const double without = cost(0.0);
  double gain = 0.0;
  // A line of N samples of white noise of one unit has a mean square of 1 / N or N, as lines are scaled.
  const double line = part.inputs.cwiseAbs2().rowwise().mean().cwiseQuotient(sizes.cwiseAbs2()).maxCoeff();
  for (double share = least_share * line; share <= line; share *= finer)
    gain = std::max(gain, without - cost(share));
  return gain;
}

LevelsOfNoise likeliest_line_noise(const DrivenProblem& problem, const VectorXd& theta, const VectorXd& sizes,
                                   bool keep_inputs) {
  constexpr int most_steps = 100;
  constexpr double settled = 0.005, least = 1e-12;  // of a variance; of the residual's
  constexpr Index most_numbers = 6000;
  const LinearResponse response = DrivenMotion(problem).response(theta);
  const RecordLines& all = problem.parts.front();
  const RecordLines part = thinned(all, all.outputs.size() / most_numbers + 1);
  const Index p = part.outputs.rows(), m = part.inputs.rows(), count = part.omega.size();
  const MatrixXcd left = lines_left(PartAt(problem, response, part), p);
  const std::vector<MatrixXcd> by_inputs = motions_by_inputs(problem, response, part, VectorXd::Ones(m));
  const VectorXd squares = left.cwiseAbs2().rowwise().mean().cwiseMax(1e-300);
  VectorXd variance(p + m);
  variance << squares, sizes.cwiseAbs2();
  const auto varied = Eigen::seqN(0, keep_inputs ? p : p + m);
  MatrixXcd columns(p, p + m), solved;
  columns.leftCols(p).setIdentity();
  Eigen::LLT<MatrixXcd> factor;
  const auto solve_line = [&](Index k) {  // L_k, S_k^-1 of the columns
    for (Index j = 0; j < m; ++j) columns.col(p + j) = by_inputs[static_cast<std::size_t>(j)].col(k);
    factor.compute(columns * variance.asDiagonal() * columns.adjoint());
    solved = factor.solve(columns);
  };
  for (int step = 0; step < most_steps; ++step) {
    VectorXd found = VectorXd::Zero(p + m), expected = found;
    for (Index k = 0; k < count; ++k) {
      solve_line(k);
      found += (solved.adjoint() * left.col(k)).cwiseAbs2();
      expected += columns.conjugate().cwiseProduct(solved).real().colwise().sum().transpose();
    }
    VectorXd next = variance;
    next(varied) = variance(varied).cwiseProduct(
        (found(varied).cwiseQuotient(expected(varied).cwiseMax(1e-300))).cwiseSqrt());
    next.head(p) = next.head(p).cwiseMax(least * squares);
    const double moved = (next - variance).cwiseQuotient(variance.cwiseMax(1e-300)).cwiseAbs().maxCoeff();
    variance = next;
    if (moved < settled) break;
  }
  MatrixXd information = MatrixXd::Zero(p + m, p + m);  // of the logarithms of the variances
  const std::vector<Index> edges = band_edges(part.omega);
  double statistic = 0.0;
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    const double lines = static_cast<double>(edges[b + 1] - edges[b]);
    VectorXd mean = VectorXd::Zero(p);
    for (Index k = edges[b]; k < edges[b + 1]; ++k) {
      solve_line(k);
      information += (columns.adjoint() * solved).cwiseAbs2();
      mean += factor.matrixL().solve(left.col(k)).cwiseAbs2() / lines;
    }
    statistic += 2.0 * lines * (mean.array() - 1.0 - mean.array().log()).sum();
  }
  const double freedom = static_cast<double>(
      std::max<Index>(1, static_cast<Index>(edges.size() - 1) * p - (keep_inputs ? p : p + m)));
  const boost::math::chi_squared_distribution<double, InDouble> law(freedom);
  const double stride = static_cast<double>(all.omega.size()) / static_cast<double>(count);
  information = stride * (variance.asDiagonal() * information * variance.asDiagonal()).eval();
  const VectorXd spread = information.ldlt().solve(MatrixXd::Identity(p + m, p + m)).diagonal();
  return {variance.head(p).cwiseSqrt().cwiseQuotient(problem.weights), variance.tail(m).cwiseSqrt(),
          0.5 * spread.tail(m).cwiseMax(0.0).cwiseSqrt(), cdf(complement(law, statistic))};
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

/// sum_k a_k a_k^T (r_k / (1 - h_k))^2 over the lines, a_k the rows of orthonormal axes and h_k = |a_k|^2.
MatrixXd variance_along(const MatrixXd& axes, const VectorXd& rest) {
  const Index half = axes.rows() / 2;
  MatrixXd variance = MatrixXd::Zero(axes.cols(), axes.cols());
  for (Index k = 0; k < half; ++k) {
    const double weight = axes.row(k).squaredNorm() + axes.row(k + half).squaredNorm();
    const VectorXd line =
        (axes.row(k) * rest[k] + axes.row(k + half) * rest[k + half]) / std::max(1e-3, 1.0 - weight);
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
               spread = std::sqrt(variance_along(axis, at_once_ - sum * axis)(0, 0));
  return Score{change, spread / size, std::abs(sum) / std::max(spread, 1e-300),
               sum * sum / std::max(left().squaredNorm(), 1e-300), -change * coefficients};
}

double LineScores::together(const MatrixXd& directions) const {
  const MatrixXd own = directions - slopes_ * normal_.solve(slopes_.transpose() * directions);
  Eigen::ColPivHouseholderQR<MatrixXd> factors(own.rows(), own.cols());
  factors.setThreshold(1e-3);
  factors.compute(own);
  const MatrixXd axes = factors.householderQ() * MatrixXd::Identity(own.rows(), factors.rank());
  const VectorXd sum = axes.transpose() * at_once_;
  return sum.dot(variance_along(axes, at_once_ - axes * sum).ldlt().solve(sum));
}

}  // namespace beamid::experiments
