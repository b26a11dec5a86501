// What a filter sees of a model.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "filters/continuous_model.hpp"
#include "filters/scheme.hpp"

namespace beamid::filters {

/// z_k+1 = F(z_k, u_k) + w,  y_k = h(z_k, u_k) + v,  w ~ N(0, Q), v ~ N(0, R).
///
/// u_k tells how the m inputs run from sample k to the next: [p_0; ...; p_d] of StepInput (m (d + 1)), the
/// inputs at the sample first. With m entries they are held.
///
/// Models may keep work space: each filter owns one.
class DiscreteModel {
 public:
  virtual ~DiscreteModel() = default;

  virtual std::vector<Label> state_labels() const = 0;       ///< n
  virtual std::vector<Label> output_labels() const = 0;      ///< p
  virtual const Eigen::MatrixXd& process_noise() const = 0;  ///< Q (n x n); may be empty: none
  virtual const Eigen::MatrixXd& output_noise() const = 0;   ///< R (p x p)

  virtual double interval() const = 0;  ///< between successive states [s]
  /// Another interval from now on; Q grows in proportion to it, as that of white noise does.
  /// @throws std::invalid_argument where dt <= 0 or the model has one interval only, as is the default.
  virtual void set_interval(double dt);

  virtual void transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                          Eigen::VectorXd& next) = 0;
  /// F(z, u) and its Jacobian (n x n); central differences unless overridden.
  virtual void linearised_transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                                     Eigen::VectorXd& next, Eigen::MatrixXd& jacobian);

  /// F(z, u) and the directions J d of a block of directions d (n x r), in place. Where J has structure this
  /// costs O(n r), and J is never formed; the default forms it.
  virtual void move(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& next,
                    Eigen::MatrixXd& directions);

  virtual void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                      Eigen::VectorXd& output) = 0;
  /// dh/dz (p x n); central differences unless overridden.
  virtual void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                               Eigen::MatrixXd& jacobian);
};

/// Covariances of the white noise of a sampled model.
struct Noise {
  Eigen::MatrixXd process;  ///< Q (n x n) per step; empty: none
  Eigen::MatrixXd output;   ///< R (p x p)
};

/// Noise for another interval: Q in proportion to it. @throws std::invalid_argument when dt <= 0.
void rescale(Noise& noise, double from, double dt);

/// The continuous model sampled at interval `dt` [s] by a registered scheme ("exponential", ...).
/// @throws std::invalid_argument on an unknown scheme, dt <= 0, or noise of the wrong shape.
std::unique_ptr<DiscreteModel> discretise(std::shared_ptr<const ContinuousModel> model, double dt,
                                          const std::string& scheme, Noise noise);

}  // namespace beamid::filters
