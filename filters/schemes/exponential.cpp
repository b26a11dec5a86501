// Exact motion of a linear model with constant parameters and held input:
//
//     x+ = e^(A dt) x + (integral_0^dt e^(A s) ds) B u,    theta+ = theta
//
// with the exact tangent: d x+/d theta_j is the directional derivative of the exponential along dA/dtheta_j.
// The input enters by augmenting A to [A B; 0 0] [vanloan1978].
#include "filters/scheme.hpp"
#include "filters/schemes/matrix_exponential.hpp"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class Exponential final : public Scheme {
 public:
  void step(const ContinuousModel& model, const VectorXd& state, const VectorXd& input, double dt,
            VectorXd& next, MatrixXd* tangent) override {
    if (&model != model_) bind(model);
    linear_->motion_matrix(state, a_);
    next = state;
    if (linear_->motion_size() == 2 && linear_->input_size() == 0)
      step_oscillator(state, dt, next, tangent);
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

  void step_oscillator(const VectorXd& state, double dt, VectorXd& next, MatrixXd* tangent) {
    const Exponential2x2 exponential(a_.topLeftCorner<2, 2>() * dt);
    next.head<2>() = exponential.value() * state.head<2>();
    if (!tangent) return;
    tangent->setZero(state.size(), state.size());
    tangent->diagonal().setOnes();
    tangent->topLeftCorner<2, 2>() = exponential.value();
    const Eigen::Vector2d motion = state.head<2>();
    for (Index j = 0; j < linear_->parameter_size(); ++j) {
      linear_->motion_matrix_derivative(state, j, derivative_);
      const Eigen::Matrix2d slope = exponential.derivative(derivative_.topLeftCorner<2, 2>() * dt);
      tangent->block<2, 1>(0, 2 + j).noalias() = slope * motion;
    }
  }

  void step_general(const VectorXd& state, const VectorXd& input, double dt, VectorXd& next,
                    MatrixXd* tangent) {
    const Index l = linear_->motion_size(), m = linear_->input_size();
    VectorXd moved(l + m);
    moved << state.head(l), input.head(m);
    MatrixXd held = MatrixXd::Zero(l + m, l + m), value, slope;
    linear_->input_matrix(state, b_);
    held.topRows(l) << a_, b_;
    value = (held * dt).exp();
    next.head(l) = value.topRows(l) * moved;
    if (!tangent) return;
    tangent->setIdentity(state.size(), state.size());
    tangent->topLeftCorner(l, l) = value.topLeftCorner(l, l);
    MatrixXd direction = MatrixXd::Zero(l + m, l + m);
    for (Index j = 0; j < linear_->parameter_size(); ++j) {
      linear_->motion_matrix_derivative(state, j, derivative_);
      linear_->input_matrix_derivative(state, j, b_);
      direction.topRows(l) << derivative_, b_;
      exponential_with_derivative(held * dt, direction * dt, value, slope);
      tangent->col(l + j).head(l) = slope.topRows(l) * moved;
    }
  }

  const ContinuousModel* model_ = nullptr;
  const LinearMotion* linear_ = nullptr;
  MatrixXd a_, b_, derivative_;
};

const bool registered =
    scheme_registry().add({"exponential",
                           "exact for linear motion with constant parameters, tangents included",
                           "[vanloan1978]",
                           {},
                           {},
                           [](const Options&) { return std::make_unique<Exponential>(); }});

}  // namespace
}  // namespace beamid::filters
