// What a model says about motion in continuous time.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "filters/gaussian.hpp"

namespace beamid::filters {

class DiscreteModel;
struct Noise;

/// z' = f(z, u),  y = h(z, u): state z (n), input u (m), output y (p), all at one instant.
///
/// Jacobians are central differences unless a model gives its own.
class ContinuousModel {
 public:
  virtual ~ContinuousModel() = default;

  virtual Eigen::Index input_size() const { return 0; }
  virtual std::vector<Label> state_labels() const = 0;   ///< n
  virtual std::vector<Label> output_labels() const = 0;  ///< p

  /// f(z, u) (n)
  virtual void rate(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                    Eigen::VectorXd& rate) const = 0;
  /// df/dz (n x n)
  virtual void rate_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                             Eigen::MatrixXd& jacobian) const;
  /// h(z, u) (p)
  virtual void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                      Eigen::VectorXd& output) const = 0;
  /// dh/dz (p x n)
  virtual void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                               Eigen::MatrixXd& jacobian) const;

  /// The model's own discretisation by a registered scheme, where it knows a faster way to the same numbers
  /// than the scheme does, or null. discretise() asks for it first.
  virtual std::unique_ptr<DiscreteModel> structured(double dt, const std::string& scheme,
                                                    const Noise& noise) const;
};

/// Linear motion with unknown constant parameters: z = [x; theta], x' = A(theta) x + B(theta) u, theta' = 0.
///
/// The `exponential` scheme moves such a model exactly, and its tangents too.
class LinearMotion : public ContinuousModel {
 public:
  virtual Eigen::Index motion_size() const = 0;     ///< of x (l)
  virtual Eigen::Index parameter_size() const = 0;  ///< of theta (q)

  /// A (l x l)
  virtual void motion_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const = 0;
  /// dA/dtheta_j (l x l)
  virtual void motion_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                                        Eigen::MatrixXd& matrix) const = 0;
  /// B (l x m); zero unless overridden
  virtual void input_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const;
  /// dB/dtheta_j (l x m); zero unless overridden
  virtual void input_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                                       Eigen::MatrixXd& matrix) const;

  void rate(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& rate) const final;
  void rate_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                     Eigen::MatrixXd& jacobian) const final;
};

}  // namespace beamid::filters
