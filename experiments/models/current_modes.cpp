#include "experiments/models/current_modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "experiments/models/motion/second_order_motion.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

JointModel with_modes_at(JointModel model, const VectorXd& state) {
  const auto* motion = dynamic_cast<const SecondOrderMotion*>(model.motion.get());
  if (!motion || !motion->has_modes_of_its_own()) return model;
  SecondOrderForm form;
  motion->evaluate(state, form, nullptr);
  // W = M^-1 K with M and K symmetric: real eigenvalues omega^2.
  const Eigen::EigenSolver<MatrixXd> solver(form.stiffness);
  const VectorXd squares = solver.eigenvalues().real();
  const MatrixXd vectors = solver.eigenvectors().real();
  std::vector<Index> order(static_cast<std::size_t>(squares.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return squares[a] < squares[b]; });
  for (Index i = 0; i < model.mode_shapes.cols(); ++i) {
    const Index k = order[static_cast<std::size_t>(i)];
    const double reach = (motion->rows() * vectors.col(k)).cwiseAbs().maxCoeff();
    if (!(squares[k] >= 0.0) || !(reach > 0.0))
      throw std::runtime_error("the model does not oscillate at these values of its unknowns");
    model.mode_frequencies[i] = std::sqrt(squares[k]);
    model.mode_shapes.col(i) = vectors.col(k) / reach;
  }
  return model;
}

MatrixXd motion_slopes(const JointModel& model, const VectorXd& state) {
  const Index r = model.motion_size(), q = static_cast<Index>(model.unknowns.size());
  MatrixXd slopes = MatrixXd::Zero(state.size(), q);
  const auto* motion = dynamic_cast<const SecondOrderMotion*>(model.motion.get());
  if (!motion || !motion->has_modes_of_its_own()) return slopes;
  const MatrixXd& shapes = model.mode_shapes;
  MatrixXd start(r, 2);
  start << state.head(r), state.segment(r, r);
  const MatrixXd amplitudes = shapes.colPivHouseholderQr().solve(start);  // a, b (k x 2)
  // The same modes elsewhere: their part along each shape held at one, which makes Phi(eta) smooth.
  const auto moved = [&](std::size_t j, double step) -> MatrixXd {
    VectorXd there = state;
    there[model.unknown_places[j]] += step;
    MatrixXd other = with_modes_at(model, there).mode_shapes;
    for (Index i = 0; i < shapes.cols(); ++i)
      other.col(i) *= shapes.col(i).squaredNorm() / other.col(i).dot(shapes.col(i));
    return other * amplitudes;
  };
  for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
    const Unknown& unknown = model.unknowns[j];
    const double step = 1e-4 * unknown.deviation / std::abs(unknown.slope(state[model.unknown_places[j]]));
    const MatrixXd slope = (moved(j, step) - moved(j, -step)) / (2.0 * step);
    slopes.col(static_cast<Index>(j)).head(2 * r) = slope.reshaped();
  }
  return slopes;
}

}  // namespace beamid::experiments
