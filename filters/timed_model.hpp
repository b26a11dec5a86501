// A discrete model whose interval may change.
#pragma once

#include <utility>

#include "filters/discrete_model.hpp"

namespace beamid::filters {

/// Keeps the interval and the noise, which goes with it.
class TimedModel : public DiscreteModel {
 public:
  const Eigen::MatrixXd& process_noise() const final { return noise_.process; }
  const Eigen::MatrixXd& output_noise() const final { return noise_.output; }
  double interval() const final { return interval_; }
  void set_interval(double dt) final {
    if (dt == interval_) return;
    rescale(noise_, interval_, dt);
    interval_ = dt;
    interval_changed();
  }

 protected:
  TimedModel(double dt, Noise noise) : interval_(dt), noise_(std::move(noise)) {}

 private:
  /// What was prepared for the former interval is void.
  virtual void interval_changed() {}

  double interval_;
  Noise noise_;
};

}  // namespace beamid::filters
