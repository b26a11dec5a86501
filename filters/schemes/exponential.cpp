// Exact motion of a linear model with constant parameters and inputs that are polynomials of the step
// (StepInput):
//
//     x+ = e^Z x + dt integral_0^1 e^(Z (1 - s)) B u(s) ds,   Z = A dt,    theta+ = theta
//
// with the exact tangent: d x+/d theta_j is the directional derivative of the exponential along dA/dtheta_j.
// The powers s^j / j! are a chain of integrators, so that the inputs enter by augmenting A [vanloan1978].
// Two coordinates take the exponential in closed form, and the integral too (forced_oscillator.hpp).
#include "filters/scheme.hpp"
#include "filters/schemes/forced_oscillator.hpp"
#include "filters/schemes/matrix_exponential.hpp"
#include "filters/step_input.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <optional>
#include <unsupported/Eigen/MatrixFunctions>

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::Matrix2d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

class Exponential final : public Scheme {
 public:
  void step(const ContinuousModel& model, const VectorXd& state, const VectorXd& input, double dt,
            VectorXd& next, MatrixXd* tangent) override {
    if (&model != model_) bind(model);
    linear_->motion_matrix(state, a_);
    next = state;
    const bool forced = linear_->input_size() > 0 && input.size() > 0;
    if (linear_->motion_size() == 2 && (!forced || ForcedOscillator::takes(a_ * dt)))
      step_oscillator(state, input, dt, next, tangent);
    else
      step_general(state, input, dt, next, tangent);
  }

  Amplification amplification(std::complex<double> z) const override { return {std::exp(z), std::exp(z)}; }

 private:
  void bind(const ContinuousModel& model) {
    linear_ = dynamic_cast<const LinearMotion*>(&model);
    if (!linear_)
      throw std::invalid_argument(
          "discretisation 'exponential' moves linear motion only; this model is nonlinear");
    model_ = &model;
  }

  void step_oscillator(const VectorXd& state, const VectorXd& input, double dt, VectorXd& next,
                       MatrixXd* tangent) {
    const Matrix2d z = a_ * dt;
    if (!last_ || z != last_z_) last_.emplace(z), last_z_ = z;  // parameters that rest, equal steps
    const Exponential2x2& exponential = *last_;
    std::optional<ForcedOscillator> forced;
    const StepInput path(input, linear_->input_size());
    next.head<2>() = exponential.value() * state.head<2>();
    if (path.size() > 0 && linear_->input_size() > 0) {
      linear_->input_matrix(state, b_);
      forced.emplace(z, exponential.value(), pushes_of(path, dt));
      next.head<2>() += forced->value();
    }
    if (!tangent) return;
    tangent->setZero(state.size(), state.size());
    tangent->diagonal().setOnes();
    tangent->topLeftCorner<2, 2>() = exponential.value();
    const Vector2d motion = state.head<2>();
    for (Index j = 0; j < linear_->parameter_size(); ++j) {
      linear_->motion_matrix_derivative(state, j, derivative_);
      const Matrix2d turn = derivative_.topLeftCorner<2, 2>() * dt, slope = exponential.derivative(turn);
      tangent->block<2, 1>(0, 2 + j).noalias() = slope * motion;
      if (!forced) continue;
      linear_->input_matrix_derivative(state, j, b_);
      tangent->block<2, 1>(0, 2 + j) += forced->derivative(turn, slope, pushes_of(path, dt));
    }
  }

  // dt B p_j, of the matrix in b_
  ForcedOscillator::Pushes pushes_of(const StepInput& path, double dt) const {
    ForcedOscillator::Pushes found(2, path.degree() + 1);
    for (Index j = 0; j <= path.degree(); ++j) found.col(j) = dt * (b_ * path.coefficient(j));
    return found;
  }

  void step_general(const VectorXd& state, const VectorXd& input, double dt, VectorXd& next,
                    MatrixXd* tangent) {
    const Index l = linear_->motion_size();
    const StepInput path(input, linear_->input_size());
    const Index chain = path.size() > 0 ? path.degree() + 1 : 0;
    MatrixXd augmented = MatrixXd::Zero(l + chain, l + chain), value, slope;
    augmented.topLeftCorner(l, l) = a_ * dt;
    linear_->input_matrix(state, b_);
    double scale = 1.0;  // of the chain: the inputs are then no larger than the chain itself
    if (chain > 0) {
      augmented.topRightCorner(l, chain) = pushes(path, dt);
      scale = std::max(augmented.topRightCorner(l, chain).cwiseAbs().colwise().sum().maxCoeff(), 1e-300);
      augmented.topRightCorner(l, chain) /= scale;
      augmented.bottomRightCorner(chain, chain).diagonal(-1).setOnes();
    }
    VectorXd moved = VectorXd::Zero(l + chain);
    moved.head(l) = state.head(l);
    if (chain > 0) moved[l] = scale;
    value = augmented.exp();
    next.head(l) = value.topRows(l) * moved;
    if (!tangent) return;
    tangent->setIdentity(state.size(), state.size());
    tangent->topLeftCorner(l, l) = value.topLeftCorner(l, l);
    // What rests and is not pushed rests whatever the parameters: linear_gaussian() reads its matrices there.
    if (state.head(l).isZero(0.0) && augmented.topRightCorner(l, chain).isZero(0.0)) return;
    MatrixXd direction = MatrixXd::Zero(l + chain, l + chain);
    for (Index j = 0; j < linear_->parameter_size(); ++j) {
      linear_->motion_matrix_derivative(state, j, derivative_);
      linear_->input_matrix_derivative(state, j, b_);
      direction.topLeftCorner(l, l) = derivative_ * dt;
      if (chain > 0) direction.topRightCorner(l, chain) = pushes(path, dt) / scale;
      exponential_with_derivative(augmented, direction, value, slope);
      tangent->col(l + j).head(l) = slope.topRows(l) * moved;
    }
  }

  // dt j! B p_j in columns (l x (d + 1)), of the matrix in b_
  MatrixXd pushes(const StepInput& path, double dt) const {
    MatrixXd columns(b_.rows(), path.degree() + 1);
    double factorial = dt;
    for (Index j = 0; j <= path.degree(); ++j) {
      if (j > 1) factorial *= static_cast<double>(j);
      columns.col(j) = factorial * (b_ * path.coefficient(j));
    }
    return columns;
  }

  const ContinuousModel* model_ = nullptr;
  const LinearMotion* linear_ = nullptr;
  MatrixXd a_, b_, derivative_;
  Matrix2d last_z_ = Matrix2d::Zero();
  std::optional<Exponential2x2> last_;  // of last_z_
};

const bool exponential_registered =
    scheme_registry().add({"exponential",
                           "exact for linear motion with constant parameters, tangents included",
                           "[vanloan1978]",
                           {},
                           {},
                           [](const Options&) { return std::make_unique<Exponential>(); }});

}  // namespace
}  // namespace beamid::filters
