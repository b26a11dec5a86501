// One degree of freedom whose stiffness, damping and mass are all unknown, and the test made of it.
#pragma once

#include <cmath>

#include "experiments/identify/bounds/identifiability.hpp"

namespace beamid::test {

/// z = [x, v, K, C, M],  M x'' + C x' + K x = f.  Observed: the acceleration.
class FreeOscillator final : public filters::LinearMotion {
 public:
  explicit FreeOscillator(bool forced) : forced_(forced) {}

  Eigen::Index input_size() const override { return forced_ ? 1 : 0; }
  std::vector<filters::Label> state_labels() const override;
  std::vector<filters::Label> output_labels() const override { return {{"acceleration", "m/s2"}}; }
  Eigen::Index motion_size() const override { return 2; }
  Eigen::Index parameter_size() const override { return 3; }

  void motion_matrix(const Eigen::VectorXd& z, Eigen::MatrixXd& matrix) const override;
  void motion_matrix_derivative(const Eigen::VectorXd& z, Eigen::Index j,
                                Eigen::MatrixXd& matrix) const override;
  void input_matrix(const Eigen::VectorXd& z, Eigen::MatrixXd& matrix) const override;
  void input_matrix_derivative(const Eigen::VectorXd& z, Eigen::Index j,
                               Eigen::MatrixXd& matrix) const override;
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd& f, Eigen::VectorXd& y) const override;

 private:
  bool forced_;
};

/// Of the first `unknowns` of K, C, M: the mass is known where there are two.
experiments::ObservedMotion oscillating(double mass, double frequency_hz, double ratio, double displacement,
                                        double interval, int unknowns, bool forced = false);

/// Of each unknown over its value, read for so many samples.
Eigen::VectorXd bounds_of(const experiments::ObservedMotion& motion, Eigen::Index samples, double noise);

}  // namespace beamid::test
