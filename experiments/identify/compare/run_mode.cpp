#include "experiments/identify/compare/run_mode.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

// |C v| of every eigenvector of the motion: what the sensors see of it.
VectorXd sight_of(const filters::LinearMotion& motion, const VectorXd& state,
                  const Eigen::EigenSolver<MatrixXd>& solver) {
  MatrixXd sensors;
  motion.output_jacobian(state, VectorXd::Zero(motion.input_size()), sensors);
  return (sensors.leftCols(solver.eigenvalues().size()) * solver.eigenvectors()).colwise().norm();
}

// How far the measured inputs reach every eigenvalue of the motion, and the sensors see it, as a share of the
// largest: |C v| |w^T B| of its right and left eigenvectors v, w; of a free motion |C v|. Eigenvalues that
// are the same share theirs.
VectorXd shares_of_record(const filters::LinearMotion& motion, const VectorXd& state, const MatrixXd& rates,
                          const Eigen::EigenSolver<MatrixXd>& solver) {
  constexpr double same = 1e-6;
  const Index n = rates.rows();
  MatrixXd through;
  motion.input_matrix(state, through);
  const Eigen::VectorXcd& lambda = solver.eigenvalues();
  const VectorXd sight = sight_of(motion, state, solver);
  VectorXd reach = VectorXd::Ones(n);
  if (through.size() > 0 && !through.isZero(0.0)) {
    const Eigen::EigenSolver<MatrixXd> left(rates.transpose());
    const VectorXd pushed = (through.transpose() * left.eigenvectors()).colwise().norm();
    for (Index i = 0; i < n; ++i) {
      reach[i] = 0.0;
      for (Index k = 0; k < n; ++k)
        if (std::abs(left.eigenvalues()[k] - lambda[i]) <= same * std::abs(lambda[i])) reach[i] += pushed[k];
    }
  }
  VectorXd share(n);
  for (Index i = 0; i < n; ++i) {
    double sum = 0.0;
    for (Index k = 0; k < n; ++k)
      if (std::abs(lambda[k] - lambda[i]) <= same * std::abs(lambda[i])) sum += sight[k];
    share[i] = sum * reach[i];
  }
  const double largest = share.maxCoeff();
  return largest > 0.0 ? VectorXd(share / largest) : VectorXd::Ones(n);
}

// Oscillations that the record holds, with their shares of it; the slowest first.
std::vector<std::pair<FoundMode, double>> oscillations(const filters::LinearMotion& motion,
                                                       const VectorXd& state) {
  constexpr double at_rest = 1e-6;  // of the fastest rate: what rounding makes of a motion without stiffness
  constexpr double in_record = 1e-8;
  MatrixXd rates;
  motion.motion_matrix(state, rates);
  const Eigen::EigenSolver<MatrixXd> solver(rates);
  const Eigen::VectorXcd& eigenvalues = solver.eigenvalues();
  const double fastest = eigenvalues.cwiseAbs().maxCoeff();
  const VectorXd share = shares_of_record(motion, state, rates, solver);
  std::vector<std::pair<FoundMode, double>> found;
  for (Index i = 0; i < eigenvalues.size(); ++i) {
    const std::complex<double> lambda = eigenvalues[i];
    if (!(lambda.imag() > at_rest * fastest) || !(share[i] > in_record)) continue;
    const double frequency = std::abs(lambda) / (2.0 * std::numbers::pi);
    found.emplace_back(FoundMode{frequency, -lambda.real() / std::abs(lambda)}, share[i]);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first.frequency_hz < b.first.frequency_hz; });
  return found;
}

// Of the slowest and of those with a tenth of the largest share, the one nearest to a frequency.
FoundMode nearest(const std::vector<std::pair<FoundMode, double>>& found, double hz) {
  constexpr double strong = 0.1;
  const auto distance = [&](const FoundMode& mode) { return std::abs(std::log(mode.frequency_hz / hz)); };
  FoundMode best = found.front().first;
  for (const auto& [mode, share] : found)
    if (share > strong && distance(mode) < distance(best)) best = mode;
  return best;
}

void add_deviations(const filters::LinearMotion& motion, const VectorXd& state,
                    const filters::Gaussian& unknowns, const std::vector<Index>& places, FoundMode& found) {
  constexpr double part = 0.01;  // of a deviation
  MatrixXd slopes = MatrixXd::Zero(2, unknowns.mean.size());
  for (Index j = 0; j < slopes.cols(); ++j) {
    const double step = part * std::sqrt(unknowns.covariance(j, j));
    VectorXd moved = state;
    moved[places[static_cast<std::size_t>(j)]] += step;
    if (const auto modes = oscillations(motion, moved); !modes.empty() && step > 0.0) {
      const FoundMode mode = nearest(modes, found.frequency_hz);
      slopes.col(j) << (mode.frequency_hz - found.frequency_hz) / step,
          (mode.damping_ratio - found.damping_ratio) / step;
    }
  }
  const Eigen::Vector2d variance =
      (slopes * unknowns.covariance * slopes.transpose()).diagonal().cwiseMax(0.0);
  found.frequency_deviation_hz = std::sqrt(variance[0]);
  found.damping_ratio_deviation = std::sqrt(variance[1]);
}

}  // namespace

std::optional<RecordedModes> recorded_modes(const JointModel& model, const VectorXd& state,
                                            const filters::Gaussian& unknowns,
                                            std::optional<double> record_hz) {
  const auto* motion = dynamic_cast<const filters::LinearMotion*>(model.motion.get());
  if (!motion) return {};
  const auto found = oscillations(*motion, state);
  if (found.empty()) return {};
  const FoundMode& lowest = found.front().first;
  RecordedModes modes{lowest, record_hz ? nearest(found, *record_hz) : lowest};
  add_deviations(*motion, state, unknowns, model.unknown_places, modes.shown);
  return modes;
}

std::vector<std::complex<double>> seen_rates(const JointModel& model, const VectorXd& state) {
  constexpr double least = 0.02;
  const auto* motion = dynamic_cast<const filters::LinearMotion*>(model.motion.get());
  if (!motion) return {};
  MatrixXd rates;
  motion->motion_matrix(state, rates);
  const Index n = rates.rows();
  const Eigen::EigenSolver<MatrixXd> solver(rates);
  const Eigen::VectorXcd part =  // of the motion
      solver.eigenvectors().fullPivLu().solve(state.head(n).cast<std::complex<double>>());
  const VectorXd seen = sight_of(*motion, state, solver).cwiseProduct(part.cwiseAbs());
  std::vector<std::complex<double>> found;
  for (Index i = 0; i < n; ++i)
    if (solver.eigenvalues()[i].imag() > 0.0 && seen[i] > least * seen.maxCoeff())
      found.push_back(solver.eigenvalues()[i]);
  return found;
}

}  // namespace beamid::experiments
