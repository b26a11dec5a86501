// One degree of freedom on an odd spring of any shape, elastic or with Masing's loop.
#pragma once

#include "experiments/identify/backbone/secant_curve.hpp"
#include "experiments/record/record.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

struct LoopMotionSetting {
  SecantCurve spring{1.0, 1}, damping{1.0, 1};  ///< s and c
  double mass = 1;                              ///< M [kg]
  double omega = 1;                             ///< of the motion's beginning [rad/s]: where it came from
  Quantity observed = Quantity::displacement;
  double interval = 1;      ///< between samples [s]
  int steps = 1;            ///< in it
  double noise = 1;         ///< standard deviation of a reading
  bool hysteretic = false;  ///< else mu = 0 whatever the state holds
};

/// M x'' + c(|x|) x' + (1 - mu) F(x) + H = 0, F(x) = x s(|x|), H = H_r + 2 mu F((x - x_r) / 2) [masing1926],
/// x_r and H_r being displacement and force at the last reversal: mu = 0 is an elastic spring, 1 Masing's
/// loop. State [x, x', x_r, H_r, begun, theta (q), damping's coefficients (d), mu, b], b the offset of the
/// one channel. Before the first step `begun` is 0: the reversal before it is that of a cycle of the
/// amplitude |x - i x' / omega|, where the force was mu F(x_r) and what H_r holds.
///
/// Runge-Kutta of order four in `steps` steps, a step with a reversal cut there. Force and displacement run
/// on through a reversal and the velocity is zero there, so tangents are exact without jumps.
class LoopMotion final : public filters::DiscreteModel {
 public:
  explicit LoopMotion(const LoopMotionSetting& setting);

  /// Places in the state.
  static constexpr Eigen::Index displacement = 0, velocity = 1, reversal = 2, reversal_force = 3, begun = 4,
                                spring = 5;
  Eigen::Index damping() const { return spring + set_.spring.terms(); }
  Eigen::Index masing() const { return damping() + set_.damping.terms(); }
  Eigen::Index offset() const { return masing() + 1; }
  Eigen::Index states() const { return masing() + 2; }

  std::vector<filters::Label> state_labels() const override;
  std::vector<filters::Label> output_labels() const override;
  const Eigen::MatrixXd& process_noise() const override { return none_; }
  const Eigen::MatrixXd& output_noise() const override { return noise_; }
  double interval() const override { return set_.interval; }
  void set_interval(double dt) override { set_.interval = dt; }
  void transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& next) override;
  void linearised_transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                             Eigen::VectorXd& next, Eigen::MatrixXd& jacobian) override;
  void move(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& next,
            Eigen::MatrixXd& directions) override;
  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& output) override;
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) override;

 private:
  LoopMotionSetting set_;
  Eigen::MatrixXd none_, noise_;
  Eigen::VectorXd gradient_, before_;
  Eigen::MatrixXd directions_before_;

  double loop_force(const Eigen::VectorXd& z, Eigen::VectorXd* gradient) const;
  double acceleration(const Eigen::VectorXd& z, Eigen::VectorXd* gradient) const;
  void begin(Eigen::VectorXd& z, Eigen::MatrixXd* directions) const;
  void runge_kutta(double h, Eigen::VectorXd& z, Eigen::MatrixXd* directions);
  void step(double h, Eigen::VectorXd& z, Eigen::MatrixXd* directions);
  void advance(const Eigen::VectorXd& state, Eigen::VectorXd& next, Eigen::MatrixXd* directions);
};

}  // namespace beamid::experiments
