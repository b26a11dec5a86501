#include "experiments/identify/tracking/ringing_model.hpp"

#include <array>
#include <numbers>
#include <stdexcept>

#include <Eigen/Core>

#include "experiments/identify/tracking/tracking.hpp"
#include "filters/algorithms/oscillator.hpp"
#include "filters/batch.hpp"
#include "filters/filter.hpp"

namespace beamid::experiments {

using namespace ringing;

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using Motion = filters::algorithms::RingingOscillator<double>;

// The entries that move without the two integrals, in the order of Motion.
constexpr std::array<Eigen::Index, Motion::states> own{signal, slope, stiffness, damping, offset};

class RingingModel final : public filters::DiscreteModel {
 public:
  RingingModel(double w0, double interval, filters::Noise noise)
      : interval_(interval),
        noise_(std::move(noise)),
        motion_(w0, interval, noise_.process(own, own), noise_.output) {}

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
  double interval_;
  filters::Noise noise_;
  Motion motion_;

  void move_exactly(const VectorXd& z, VectorXd& next, MatrixXd* jacobian) const {
    const Motion::State now = z(own);
    Motion::State moved;
    filters::algorithms::Matrix<double, Motion::states> tangent;
    if (jacobian) {
      motion_.linearised_transition(now, moved, tangent);
      jacobian->setIdentity(size, size);
      (*jacobian)(own, own) = tangent;
      (*jacobian)(stiffness_integral, stiffness) = (*jacobian)(damping_integral, damping) = interval_;
    } else {
      motion_.transition(now, moved);
    }
    next = z;
    next(own) = moved;
    next[stiffness_integral] += z[stiffness] * interval_;
    next[damping_integral] += z[damping] * interval_;
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

filters::NoisyLikelihoods ringing_likelihoods(const Ringing& ringing, const filters::Measurements& span,
                                              const filters::Gaussian& initial) {
  filters::RingingTrials trials{2.0 * std::numbers::pi * ringing.centre_hz,
                                ringing.interval,
                                span.outputs.row(0),
                                {initial.mean(own), initial.covariance(own, own)}};
  return [trials = std::move(trials)](const std::vector<filters::Noise>& noises) {
    std::vector<filters::Noise> own_noises;
    for (const filters::Noise& noise : noises) own_noises.push_back({noise.process(own, own), noise.output});
    return filters::ringing_log_likelihoods(trials, own_noises);
  };
}

filters::Noise ringing_noise(const Ringing& ringing, double noise, double force, double walk) {
  filters::Noise result{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Constant(1, 1, noise * noise)};
  result.process(slope, slope) = force * force * ringing.interval;
  result.process(stiffness, stiffness) = walk * walk * ringing.interval;
  result.process(damping, damping) = 0.25 * walk * walk * ringing.interval;
  return result;
}

}  // namespace beamid::experiments
