// One force law, elastic or with Masing's loop, fitted to all samples of a decay.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/identify/backbone/decay_samples.hpp"
#include "experiments/identify/backbone/loop_motion.hpp"
#include "experiments/identify/backbone/record_fit.hpp"

namespace beamid::experiments {

/// From what a fit of a law begins.
struct LoopStart {
  std::function<double(double)> secant, damping;  ///< s(x) [N/m] and c(x) [N s/m]
  double masing = 0;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< [x, x'] at the first sample
  double offset = 0;
};

/// Where a fit has ended.
LoopStart start_after(const RecordFit& fit);

/// Fits LoopMotion, whose spring and damping are B-splines, by filters::estimate_batch.
class LoopFitter {
 public:
  /// @param noise standard deviation of a sample
  /// @param omega of the motion's beginning [rad/s]
  LoopFitter(const DecaySamples& samples, double mass, double noise, double omega)
      : samples_(samples), mass_(mass), noise_(noise), omega_(omega) {}

  /// @param name "linear", "elastic"; "masing" and "between" have a loop, the last a share of it sought
  /// @param range up to which the splines reach [m]
  /// @param grow whether the fit begins with the first cycles
  RecordFit fit(const std::string& name, Eigen::Index terms, Eigen::Index damping_terms, double range,
                const LoopStart& start, bool grow) const;

  /// The same law with ever more B-splines (of spring and damping), added to `to`; given up where the fewest
  /// do not lead anywhere. Fewer than six are steps on the way: if BIC might take them, the band would hold
  /// 92 instead of 95 of a hundred hyperbolas.
  void refine(const std::string& name, const std::vector<std::pair<Eigen::Index, Eigen::Index>>& terms,
              double range, const LoopStart& start, std::vector<RecordFit>& to) const;

 private:
  const DecaySamples& samples_;
  double mass_, noise_, omega_;

  LoopMotionSetting setting(const std::string& name, Eigen::Index terms, Eigen::Index damping_terms,
                            double range) const;
  Eigen::MatrixXd directions(const LoopMotion& motion, const LoopMotionSetting& setting, double stiffness,
                             bool masing_sought) const;
  double largest_argument(LoopMotion& motion, const Eigen::VectorXd& start, bool half_swings) const;
};

}  // namespace beamid::experiments
