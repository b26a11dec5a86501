// Iterated extended Kalman filter [bell1993]: the correction is a Gauss-Newton minimisation of
//
//     V(e) = |e|^2 + |R^-1/2 (y - h(m + L e))|^2,   P = L L^T,
//
// whose first step from e = 0 is the extended Kalman filter's. With H = dh/dz at m + L e and Y = H L,
//
//     e+ = Y^T (Y Y^T + R)^-1 (y - h(m + L e) + Y e)
//
// and a step that does not lower V is halved. The covariance is Joseph's with the last H. Innovation and S
// are those of the prediction, at m: on linear models all is as in `ekf`.
#include <Eigen/Cholesky>
#include <limits>

#include "filters/innovation.hpp"
#include "filters/linearised_step.hpp"
#include "filters/whole_number.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class IteratedExtendedKalmanFilter final : public Filter {
 public:
  IteratedExtendedKalmanFilter(std::unique_ptr<DiscreteModel> model, double iterations, double tolerance)
      : Filter(std::move(model)),
        iterations_(whole_number(iterations, 1, "iekf", "iterations")),
        tolerance_(tolerance) {
    if (!(tolerance > 0.0))
      throw std::invalid_argument("iekf: tolerance is " + std::to_string(tolerance) +
                                  "; expected more than 0");
  }

  void reset(const Gaussian& estimate) override {
    estimate_ = as_matrix(estimate, model_);
    unfinished_ = corrections_ = 0;
  }

  void predict(const VectorXd& input) override {
    model_.linearised_transition(estimate_.mean, input, next_, tangent_);
    estimate_.mean.swap(next_);
    step_.predict(estimate_, tangent_, model_.process_noise());
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    const VectorXd predicted = estimate_.mean;
    model_.output(predicted, input, expected_);
    model_.output_jacobian(predicted, input, sensor_);
    const VectorXd innovation = output - expected_;
    VectorXd estimate = minimise(output, input);
    // Weighs the innovation at the prediction, then gives the covariance at the minimum.
    Correction linear;
    Gaussian moved = estimate_;
    linear.innovation = innovation;
    step_.correct(moved, sensor_, model_.output_noise(), linear);
    correction_ = linear;
    model_.output_jacobian(estimate, input, sensor_);
    step_.correct(estimate_, sensor_, model_.output_noise(), linear);
    estimate_.mean.swap(estimate);
    check_finite(estimate_);
  }

  const Gaussian& estimate() const override { return estimate_; }

  std::vector<std::string> remarks() const override {
    if (unfinished_ == 0) return {};
    return {"the iteration did not converge in " + std::to_string(unfinished_) + " of " +
            std::to_string(corrections_) + " corrections"};
  }

 private:
  // m + L e at the minimum of V.
  VectorXd minimise(const VectorXd& output, const VectorXd& input) {
    const MatrixXd root = square_root(estimate_.covariance, covariance_factor_);
    const MatrixXd& noise = model_.output_noise();
    noise_factor_.compute(noise);
    const bool noisy = noise_factor_.info() == Eigen::Success;  // else V is not finite: no line search
    VectorXd point = estimate_.mean, coefficients = VectorXd::Zero(root.cols());
    ++corrections_;
    const auto cost = [&](const VectorXd& e) {
      model_.output(estimate_.mean + root * e, input, expected_);
      const VectorXd residual = output - expected_;
      return e.squaredNorm() + noise_factor_.matrixL().solve(residual).squaredNorm();
    };
    double value = noisy ? cost(coefficients) : 0.0;
    for (Index i = 0; i < iterations_; ++i) {
      model_.output(point, input, expected_);
      model_.output_jacobian(point, input, jacobian_);
      const MatrixXd seen = jacobian_ * root;
      const Eigen::LLT<MatrixXd> factor(seen * seen.transpose() + noise);
      if (factor.info() != Eigen::Success) break;  // reported where the innovation is weighed
      VectorXd step = seen.transpose() * factor.solve(output - expected_ + seen * coefficients);
      step -= coefficients;
      constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
      const bool converged = step.norm() < tolerance_ ||
                             ((root * step).cwiseAbs().array() <= rounding * point.cwiseAbs().array()).all();
      bool lower = !noisy || converged;
      for (int halving = 0; !lower && halving < 20; ++halving) {
        const double tried = cost(coefficients + step);
        lower = tried <= value * (1.0 + rounding);
        if (lower)
          value = tried;
        else
          step *= 0.5;
      }
      if (!lower) return point;  // the minimum, to rounding
      coefficients += step;
      point = estimate_.mean + root * coefficients;
      if (converged) return point;
    }
    ++unfinished_;
    return point;
  }

  Index iterations_;
  double tolerance_;
  Index unfinished_ = 0, corrections_ = 0;
  Gaussian estimate_;
  LinearisedStep step_;
  VectorXd next_, expected_;
  MatrixXd tangent_, sensor_, jacobian_;
  Eigen::LLT<MatrixXd> covariance_factor_, noise_factor_;
};

const bool iekf_registered = filter_registry().add(
    {"iekf",
     "iterated extended Kalman filter: Gauss-Newton with line search in every correction",
     "[bell1993]",
     {{"iterations", 10.0, "", "largest number of Gauss-Newton steps in a correction"},
      {"tolerance", 1e-8, "", "step that ends the iteration, in standard deviations of the prediction"}},
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<IteratedExtendedKalmanFilter>(std::move(model), options.number("iterations"),
                                                             options.number("tolerance"));
     }});

}  // namespace
}  // namespace beamid::filters
