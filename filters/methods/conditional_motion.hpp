// The Gaussian motion of a linear model whose constants are given, exact.
#pragma once

#include <vector>

#include "filters/gaussian.hpp"
#include "filters/observed_model.hpp"

namespace beamid::filters {

/// One step of the record so far, as it was met.
struct RecordStep {
  bool reading = false;
  Eigen::VectorXd output, input;
  std::vector<Eigen::Index> observed;
  Eigen::MatrixXd noise;  ///< R of a reading, Q of a step
  double interval = 0.0;
};

/// Constants theta with the motion that they imply.
struct ConstantParticle {
  Eigen::VectorXd theta, mean;  ///< (q), (l)
  Eigen::MatrixXd covariance;   ///< (l x l)
  // Motion and readings given theta, as long as interval and outputs stay: x+ = A x + c, y = H x + d.
  double interval = -1.0;
  Eigen::MatrixXd a, h;
  Eigen::VectorXd c, d;
  std::vector<Eigen::Index> seen;
  double settled = 0.0;  ///< ln likelihood of the readings before the last move
  double fresh = 0.0;    ///< and since
};

/// Kalman filter of p(x | theta, y_0..k): theta are the constants that the motion of the other entries
/// depends on, x those others.
class ConditionalMotion {
 public:
  explicit ConditionalMotion(ObservedModel& model) : model_(model) {}

  /// Sorts the entries of the state into theta and x.
  /// @throws std::invalid_argument where the motion given theta is not linear.
  void reset(const Gaussian& start);

  const Gaussian& start() const { return start_; }
  const std::vector<Eigen::Index>& held() const { return held_; }  ///< places of theta (q)
  const std::vector<Eigen::Index>& free() const { return free_; }  ///< of x (l)

  /// x at the start, given theta.
  void begin(ConstantParticle& one) const;
  void move(ConstantParticle& one, const RecordStep& step);
  /// @returns ln p(y | theta, what was read before)
  /// @param expected y at the prediction (p)
  /// @param s covariance of what is new in y (p x p)
  double correct(ConstantParticle& one, const RecordStep& step, Eigen::VectorXd& expected,
                 Eigen::MatrixXd& s);
  /// The record once more, from its start; readings before `settled_steps` count as settled.
  void replay(ConstantParticle& one, const std::vector<RecordStep>& record, std::size_t settled_steps);

  /// theta and x in their places (n).
  Eigen::VectorXd state(const ConstantParticle& one) const;

 private:
  ObservedModel& model_;
  Gaussian start_;
  std::vector<Eigen::Index> held_, free_;
  Eigen::VectorXd next_;
  Eigen::MatrixXd tangent_, work_;
};

}  // namespace beamid::filters
