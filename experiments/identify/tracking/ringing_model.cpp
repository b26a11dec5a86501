#include "experiments/identify/tracking/ringing_model.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/Dense>

#include "filters/schemes/matrix_exponential.hpp"
#include "filters/stop_request.hpp"

namespace beamid::experiments {

using namespace ringing;

namespace {

using Eigen::Matrix2d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

class RingingModel final : public filters::DiscreteModel {
 public:
  RingingModel(double w0, double interval, filters::Noise noise)
      : w0_(w0), interval_(interval), noise_(std::move(noise)) {}

  std::vector<filters::Label> state_labels() const override {
    return {{"signal", "unit"},
            {"signal_rate", "unit/s"},
            {"log_stiffness_integral", "s"},
            {"damping_ratio_integral", "s"},
            {"log_stiffness", "1"},
            {"damping_ratio", "1"},
            {"sensor_offset", "unit"}};
  }
  std::vector<filters::Label> output_labels() const override { return {{"signal", "unit"}}; }
  const MatrixXd& process_noise() const override { return noise_.process; }
  const MatrixXd& output_noise() const override { return noise_.output; }
  double interval() const override { return interval_; }

  void transition(const VectorXd& z, const VectorXd&, VectorXd& next) override {
    move_exactly(z, next, nullptr);
  }
  void linearised_transition(const VectorXd& z, const VectorXd&, VectorXd& next,
                             MatrixXd& jacobian) override {
    move_exactly(z, next, &jacobian);
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& output) override {
    output.setConstant(1, z[signal] + z[offset]);
  }
  void output_jacobian(const VectorXd&, const VectorXd&, MatrixXd& jacobian) override {
    jacobian.setZero(1, size);
    jacobian(0, signal) = jacobian(0, offset) = 1.0;
  }

 private:
  double w0_, interval_;
  filters::Noise noise_;

  void move_exactly(const VectorXd& z, VectorXd& next, MatrixXd* jacobian) const {
    const double w = w0_ * std::exp(0.5 * z[stiffness]), dt = interval_;
    Matrix2d motion, by_stiffness, by_damping;
    motion << 0.0, 1.0, -w * w, -2.0 * z[damping] * w;
    const filters::Exponential2x2 exponential(motion * dt);
    const Vector2d now = z.head<2>();
    next = z;
    next.head<2>() = exponential.value() * now;
    next[stiffness_integral] += z[stiffness] * dt;
    next[damping_integral] += z[damping] * dt;
    if (!jacobian) return;
    jacobian->setIdentity(size, size);
    jacobian->topLeftCorner<2, 2>() = exponential.value();
    by_stiffness << 0.0, 0.0, -w * w, -z[damping] * w;
    by_damping << 0.0, 0.0, 0.0, -2.0 * w;
    jacobian->block<2, 1>(0, stiffness) = exponential.derivative(by_stiffness * dt) * now;
    jacobian->block<2, 1>(0, damping) = exponential.derivative(by_damping * dt) * now;
    (*jacobian)(stiffness_integral, stiffness) = (*jacobian)(damping_integral, damping) = dt;
  }
};

}  // namespace

std::unique_ptr<filters::DiscreteModel> ringing_model(double frequency_hz, double interval,
                                                      filters::Noise noise) {
  if (!(frequency_hz > 0 && interval > 0))
    throw std::invalid_argument("frequency_hz and interval; expected positive numbers");
  return std::make_unique<RingingModel>(2.0 * std::numbers::pi * frequency_hz, interval, std::move(noise));
}

namespace {

// The extended Kalman filter of the model without its integrals, for its likelihood alone.
class RingingLikelihood {
 public:
  RingingLikelihood(double w0, double interval, const filters::Noise& noise, const filters::Gaussian& initial)
      : w0_(w0),
        dt_(interval),
        r_(noise.output(0, 0)),
        q_(noise.process(kept, kept)),
        x_(initial.mean(kept)),
        p_(initial.covariance(kept, kept)) {}

  // With D = [d dt; -k -d]: e^(A dt) = c I + s D of z = d^2 - k dt, and its slopes along ln K and xi
  // (matrix_exponential.hpp) times the motion. The other rows of the tangent are those of I.
  void predict() {
    const double w = w0_ * std::exp(0.5 * x_[2]), d = x_[3] * w * dt_, k = w * w * dt_, y = x_[0], v = x_[1];
    const auto [c, s, slope] = filters::algorithms::damped_entire_functions<double>(d * d - k * dt_, d);
    const Vector2d moved(d * y + dt_ * v, -k * y - d * v);  // D (y, v)
    Eigen::Matrix<double, 2, 4> tangent;
    tangent.leftCols<2>() << c + s * d, s * dt_, -s * k, c - s * d;
    const auto along = [&, c = c, s = s, slope = slope](double of_d, double of_k) {
      const double of_z = 2.0 * d * of_d - of_k * dt_, of_c = -of_d * c + 0.5 * s * of_z,
                   of_s = -of_d * s + slope * of_z;
      return Vector2d(of_c * y + of_s * moved[0] + s * of_d * y,
                      of_c * v + of_s * moved[1] - s * (of_k * y + of_d * v));
    };
    tangent.col(2) = along(0.5 * d, k);
    tangent.col(3) = along(w * dt_, 0.0);
    x_.head<2>() = tangent.leftCols<2>() * Vector2d(y, v);
    Eigen::Matrix<double, 2, 5> carried;
    carried.noalias() = tangent * p_.topRows<4>();
    const Matrix2d square = carried.leftCols<4>() * tangent.transpose();
    p_.topRightCorner<2, 3>() = carried.rightCols<3>();
    p_.bottomLeftCorner<3, 2>() = carried.rightCols<3>().transpose();
    p_(0, 0) = square(0, 0), p_(1, 1) = square(1, 1), p_(1, 0) = p_(0, 1) = square(1, 0);
    p_ += q_;
  }

  // Joseph's form as two updates of rank one (covariance_steps.hpp). False where the filter fails.
  bool correct(double reading) {
    Vector shown = p_.col(0) + p_.col(4);
    const double variance = shown[0] + shown[4] + r_;
    if (!(variance > 0.0)) return false;
    const double innovation = reading - x_[0] - x_[4];
    const Vector gain = shown / variance;
    squares_ += innovation * innovation / variance;
    log_determinants_ += std::log(variance);
    ++readings_;
    x_ += innovation * gain;
    p_.noalias() -= gain * shown.transpose();
    shown = p_.col(0) + p_.col(4) - r_ * gain;
    p_.noalias() -= shown * gain.transpose();
    return p_.diagonal().minCoeff() >= -std::numeric_limits<double>::min();
  }

  double log_likelihood() const {
    return -0.5 * (squares_ + log_determinants_ + readings_ * std::log(2.0 * std::numbers::pi));
  }

 private:
  using Vector = Eigen::Matrix<double, 5, 1>;
  using Square = Eigen::Matrix<double, 5, 5>;
  static constexpr std::array<Eigen::Index, 5> kept{signal, slope, stiffness, damping, offset};

  double w0_, dt_, r_;
  Square q_;
  Vector x_;
  Square p_;
  double squares_ = 0.0, log_determinants_ = 0.0, readings_ = 0.0;
};

}  // namespace

double ringing_log_likelihood(double frequency_hz, double interval, const filters::Noise& noise,
                              const filters::Gaussian& initial, const VectorXd& signal) {
  constexpr double failed = -std::numeric_limits<double>::infinity();
  constexpr Eigen::Index between_looks = 4096;
  RingingLikelihood likelihood(2.0 * std::numbers::pi * frequency_hz, interval, noise, initial);
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    if (k % between_looks == 0) filters::heed_stop_request();
    if (k > 0) likelihood.predict();
    if (!likelihood.correct(signal[k])) return failed;
  }
  const double found = likelihood.log_likelihood();
  return std::isfinite(found) ? found : failed;
}

}  // namespace beamid::experiments
