// White noise of inputs and outputs, as the lines of a driven record show it.
#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/driven/driven_part.hpp"
#include "experiments/signal/in_double.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;
using Complex = std::complex<double>;

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
      width -= pole.real() / std::numbers::pi * duration;
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

namespace {

/// r_k ~ CN(0, S_k), S_k = R + G_k R_u G_k^H = L_k L_k^H, of the lines of a problem's first part, or of every
/// so many, in unit weights.
class NoisyLines {
 public:
  NoisyLines(const DrivenProblem& problem, const VectorXd& theta, const VectorXd& sizes)
      : lines_(problem.parts.front().omega.size()),
        part_(thinned(problem.parts.front(), problem.parts.front().outputs.size() / most_numbers + 1)),
        p_(part_.outputs.rows()),
        m_(part_.inputs.rows()) {
    const LinearResponse response = DrivenMotion(problem).response(theta);
    left_ = lines_left(PartAt(problem, response, part_), p_);
    by_inputs_ = motions_by_inputs(problem, response, part_, VectorXd::Ones(m_));
    squares_ = left_.cwiseAbs2().rowwise().mean().cwiseMax(1e-300);
    variance_.resize(p_ + m_);
    variance_ << squares_, sizes.cwiseAbs2();
    columns_.setIdentity(p_, p_ + m_);
  }

  VectorXd outputs() const { return variance_.head(p_).cwiseSqrt(); }
  VectorXd inputs() const { return variance_.tail(m_).cwiseSqrt(); }

  /// Finds R and, where it is asked for, R_u by steps that each make the lines likelier [zhou2019].
  void find(bool with_inputs) {
    constexpr int most_steps = 100;
    constexpr double settled = 0.005, least = 1e-12;  // of a variance; of the residual's
    const auto varied = Eigen::seqN(0, with_inputs ? p_ + m_ : p_);
    for (int step = 0; step < most_steps; ++step) {
      VectorXd found = VectorXd::Zero(p_ + m_), expected = found;
      for (Index k = 0; k < part_.omega.size(); ++k) {
        solve(k);
        found += (solved_.adjoint() * left_.col(k)).cwiseAbs2();
        expected += columns_.conjugate().cwiseProduct(solved_).real().colwise().sum().transpose();
      }
      VectorXd next = variance_;
      next(varied) = variance_(varied).cwiseProduct(
          (found(varied).cwiseQuotient(expected(varied).cwiseMax(1e-300))).cwiseSqrt());
      next.head(p_) = next.head(p_).cwiseMax(least * squares_);
      const double moved = (next - variance_).cwiseQuotient(variance_.cwiseMax(1e-300)).cwiseAbs().maxCoeff();
      variance_ = next;
      if (moved < settled) return;
    }
  }

  /// Standard deviations of ln R_u^1/2 by the information that all lines hold (m).
  VectorXd relative_deviation() {
    MatrixXd information = MatrixXd::Zero(p_ + m_, p_ + m_);  // of the logarithms of the variances
    for (Index k = 0; k < part_.omega.size(); ++k) {
      solve(k);
      information += (columns_.adjoint() * solved_).cwiseAbs2();
    }
    const double stride = static_cast<double>(lines_) / static_cast<double>(part_.omega.size());
    information = stride * (variance_.asDiagonal() * information * variance_.asDiagonal()).eval();
    const VectorXd spread = information.ldlt().solve(MatrixXd::Identity(p_ + m_, p_ + m_)).diagonal();
    return 0.5 * spread.tail(m_).cwiseMax(0.0).cwiseSqrt();
  }

  /// The probability of mean squares of L_k^-1 r_k by channels and bands that lie as far from one or farther.
  double whiteness_p() {
    const std::vector<Index> edges = band_edges(part_.omega);
    double statistic = 0.0;
    for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
      const double lines = static_cast<double>(edges[b + 1] - edges[b]);
      VectorXd mean = VectorXd::Zero(p_);
      for (Index k = edges[b]; k < edges[b + 1]; ++k) {
        solve(k);
        mean += factor_.matrixL().solve(left_.col(k)).cwiseAbs2() / lines;
      }
      statistic += 2.0 * lines * (mean.array() - 1.0 - mean.array().log()).sum();
    }
    const Index freedom = static_cast<Index>(edges.size() - 1) * p_ - (p_ + m_);
    const boost::math::chi_squared_distribution<double, InDouble> law(
        static_cast<double>(std::max<Index>(1, freedom)));
    return cdf(complement(law, statistic));
  }

 private:
  static constexpr Index most_numbers = 6000;

  void solve(Index k) {  // L_k, S_k^-1 (1, G_k)
    for (Index j = 0; j < m_; ++j) columns_.col(p_ + j) = by_inputs_[static_cast<std::size_t>(j)].col(k);
    factor_.compute(columns_ * variance_.asDiagonal() * columns_.adjoint());
    solved_ = factor_.solve(columns_);
  }

  Index lines_;
  RecordLines part_;
  Index p_, m_;
  MatrixXcd left_;                    // r_k (p x L)
  std::vector<MatrixXcd> by_inputs_;  // G_k
  VectorXd squares_, variance_;       // of the residual (p); of outputs and inputs (p + m)
  MatrixXcd columns_, solved_;        // of one line
  Eigen::LLT<MatrixXcd> factor_;
};

}  // namespace

LevelsOfNoise likeliest_line_noise(const DrivenProblem& problem, const VectorXd& theta,
                                   const VectorXd& sizes) {
  NoisyLines lines(problem, theta, sizes);
  lines.find(true);
  return {lines.outputs().cwiseQuotient(problem.weights), lines.inputs(), lines.relative_deviation(),
          lines.whiteness_p()};
}

VectorXd likeliest_output_noise(const DrivenProblem& problem, const VectorXd& theta, const VectorXd& sizes) {
  NoisyLines lines(problem, theta, sizes);
  lines.find(false);
  return lines.outputs().cwiseQuotient(problem.weights);
}

}  // namespace beamid::experiments
