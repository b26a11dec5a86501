#include "experiments/identify/compare/run_mode.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

std::optional<FoundMode> slowest(const filters::LinearMotion& motion, const VectorXd& state) {
  MatrixXd rates;
  motion.motion_matrix(state, rates);
  constexpr double at_rest = 1e-6;  // of the fastest rate: what rounding makes of a motion without stiffness
  std::optional<FoundMode> lowest;
  const Eigen::VectorXcd eigenvalues = Eigen::EigenSolver<MatrixXd>(rates, false).eigenvalues();
  const double fastest = eigenvalues.cwiseAbs().maxCoeff();
  for (const std::complex<double>& lambda : eigenvalues) {
    const double frequency = std::abs(lambda) / (2.0 * std::numbers::pi);
    if (!(lambda.imag() > at_rest * fastest) || (lowest && frequency >= lowest->frequency_hz)) continue;
    lowest = FoundMode{frequency, -lambda.real() / std::abs(lambda)};
  }
  return lowest;
}

void add_deviations(const filters::LinearMotion& motion, const VectorXd& state,
                    const filters::Gaussian& unknowns, const std::vector<Index>& places, FoundMode& found) {
  constexpr double part = 0.01;  // of a deviation
  MatrixXd slopes = MatrixXd::Zero(2, unknowns.mean.size());
  for (Index j = 0; j < slopes.cols(); ++j) {
    const double step = part * std::sqrt(unknowns.covariance(j, j));
    VectorXd moved = state;
    moved[places[static_cast<std::size_t>(j)]] += step;
    if (const auto mode = slowest(motion, moved); mode && step > 0.0)
      slopes.col(j) << (mode->frequency_hz - found.frequency_hz) / step,
          (mode->damping_ratio - found.damping_ratio) / step;
  }
  const Eigen::Vector2d variance =
      (slopes * unknowns.covariance * slopes.transpose()).diagonal().cwiseMax(0.0);
  found.frequency_deviation_hz = std::sqrt(variance[0]);
  found.damping_ratio_deviation = std::sqrt(variance[1]);
}

}  // namespace

std::optional<FoundMode> lowest_mode(const JointModel& model, const VectorXd& state,
                                     const filters::Gaussian& unknowns) {
  const auto* motion = dynamic_cast<const filters::LinearMotion*>(model.motion.get());
  if (!motion) return {};
  std::optional<FoundMode> found = slowest(*motion, state);
  if (found) add_deviations(*motion, state, unknowns, model.unknown_places, *found);
  return found;
}

}  // namespace beamid::experiments
