// Inputs that nobody measured, as random processes beside the motion: the augmented state.
#pragma once

#include <memory>
#include <vector>

#include "filters/continuous_model.hpp"

namespace beamid::filters {

/// One input as a Gaussian process, stationary of standard deviation sigma and correlation time tau, from
/// white noise w of unit intensity [hartikainen2010]:
///
///     ornstein_uhlenbeck   p' = -p / tau + sigma sqrt(2 / tau) w,   covariance sigma^2 e^(-|t| / tau)
///     matern               p' = l r,   r' = -l p - 2 l r + 2 sigma sqrt(l) w,   l = sqrt(3) / tau,
///                          covariance sigma^2 (1 + l |t|) e^(-l |t|), so that p has a derivative
///
/// or, of no bound, one that moves by sigma within tau and starts anywhere (within 100 sigma):
///
///     random_walk          p' = sigma / sqrt(tau) w
struct LatentInput {
  enum class Process { ornstein_uhlenbeck, matern, random_walk };
  Eigen::Index input = 0;  ///< column of B that it acts through
  Process process = Process::matern;
  double deviation = 1.0;         ///< sigma [unit of the input]
  double correlation_time = 1.0;  ///< tau [s]

  Eigen::Index states() const { return process == Process::matern ? 2 : 1; }
};

/// A linear motion under inputs u + p, of which u is measured and p is not:
///
///     z = [x; p, r, ...; theta],   [x; p]' = [A, B_p; 0, A_p] [x; p] + [B; 0] u + [0; L_p] w,   y = h(x, u +
///     p)
///
/// Any filter on it estimates motion, inputs and parameters together [lourens2012]. Q is that of the white
/// noise over a whole interval, through the motion as well, and not only of p.
class LatentInputs final : public LinearMotion {
 public:
  /// @throws std::invalid_argument when an input does not exist, is there twice, or a number is not positive.
  LatentInputs(std::shared_ptr<const LinearMotion> motion, std::vector<LatentInput> latent);

  const std::vector<LatentInput>& latent() const { return latent_; }
  Eigen::Index place(std::size_t latent) const { return places_[latent]; }  ///< of its p in the state
  /// Where an entry of the motion's own state is found (in z).
  Eigen::Index moved(Eigen::Index place) const { return place < own_ ? place : place + added_; }
  /// An estimate about the motion's own state, and every process as it is at any time, or starts.
  Gaussian with_latent(const Gaussian& estimate) const;
  /// Q (n x n) of an interval [s], with the constants as in this state [vanloan1978].
  Eigen::MatrixXd process_noise(const Eigen::VectorXd& state, double interval) const;

  Eigen::Index input_size() const override { return motion_->input_size(); }
  std::vector<Label> state_labels() const override;
  std::vector<Label> output_labels() const override { return motion_->output_labels(); }
  Eigen::Index motion_size() const override { return own_ + added_; }
  Eigen::Index parameter_size() const override { return motion_->parameter_size(); }
  void motion_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const override;
  void motion_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                                Eigen::MatrixXd& matrix) const override;
  void input_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const override;
  void input_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                               Eigen::MatrixXd& matrix) const override;
  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
              Eigen::VectorXd& output) const override;
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) const override;

 private:
  Eigen::VectorXd own_state(const Eigen::VectorXd& state) const;
  Eigen::VectorXd whole_input(const Eigen::VectorXd& state, const Eigen::VectorXd& input) const;
  void couple(const Eigen::MatrixXd& through, Eigen::MatrixXd& matrix) const;

  std::shared_ptr<const LinearMotion> motion_;
  std::vector<LatentInput> latent_;
  std::vector<Eigen::Index> places_;
  Eigen::Index own_ = 0, added_ = 0;  // entries of the motion, of the processes
};

}  // namespace beamid::filters
