#include "experiments/identify/tracking/ringing_model.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Dense>

#include "experiments/identify/tracking/tracking.hpp"
#include "filters/filter.hpp"
#include "filters/schemes/matrix_exponential.hpp"

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

std::unique_ptr<filters::Filter> ringing_filter(const Ringing& ringing, const filters::Noise& noise,
                                                const std::string& method) {
  return filters::filter_registry().make(method, {},
                                         ringing_model(ringing.centre_hz, ringing.interval, noise));
}

filters::Noise ringing_noise(const Ringing& ringing, double noise, double force, double walk) {
  filters::Noise result{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Constant(1, 1, noise * noise)};
  result.process(slope, slope) = force * force * ringing.interval;
  result.process(stiffness, stiffness) = walk * walk * ringing.interval;
  result.process(damping, damping) = 0.25 * walk * walk * ringing.interval;
  return result;
}

}  // namespace beamid::experiments
