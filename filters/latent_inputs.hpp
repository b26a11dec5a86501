// Inputs that nobody measured, as random processes beside the motion: the augmented state.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "filters/continuous_model.hpp"
#include "filters/discrete_model.hpp"
#include "filters/registry.hpp"

namespace beamid::filters {

// Which entries of a state are inputs that nobody measured.

// Entries of a state that an option names.

/// @param what begins the message: "dual_ekf: parameters" @param size of the state
/// @return the entries in increasing order
/// @throws std::invalid_argument where one is no whole number below `size`, or there twice.
std::vector<Eigen::Index> state_entries(const std::string& what, const std::vector<double>& stated,
                                        std::size_t size);

namespace contract {
/// Estimates inputs of which nothing is known, entries of the state called unknown_input_1, ...: within a
/// tenth of their rms where sensors read them directly and, beside, the motion.
inline constexpr const char* unknown_inputs = "unknown_inputs";
}  // namespace contract

/// The option `inputs` of filters that treat unknown inputs apart from the state.
OptionSpec unknown_inputs_option();

/// Places in the state, as stated or, where none are, of the labels "unknown_input_1", ... (LatentInputs).
/// @param filter for messages
/// @throws std::invalid_argument on a place that does not exist or is there twice, and on an input with a
/// rate of its own, which says something of it beforehand.
std::vector<Eigen::Index> find_unknown_inputs(const std::string& filter, const DiscreteModel& model,
                                              const std::vector<double>& stated);

// Inputs that were measured with noise.

/// A model whose inputs are read as u_k = u + e_k, e_k ~ N(0, R_u) white: the errors e_k (m) stand behind its
/// own state, so that the state is [z; e],
///
///     z_k+1 = F(z_k, u_k - e_k) + w,   e_k+1 ~ N(0, R_u),   y_k = h(z_k, u_k - e_k) + v
///
/// An error is held over its interval, whatever the path of the input: an interpolation spreads it over the
/// neighbouring intervals, which moves it by half of one and leaves the motion it makes, to (omega dt)^2 / 4,
/// the same. Outputs that show the input itself (a force at an accelerometer's place) share the error e_k,
/// which is why it is part of the state and not of Q alone.
class NoisyInputs final : public DiscreteModel {
 public:
  /// @param deviations of the inputs' noise (m)
  /// @throws std::invalid_argument when one is negative.
  NoisyInputs(std::unique_ptr<DiscreteModel> model, Eigen::VectorXd deviations);

  /// An estimate about z, and the first error as uncertain as any; back again.
  Gaussian with_errors(const Gaussian& estimate) const;
  Gaussian without_errors(const Gaussian& estimate) const;

  std::vector<Label> state_labels() const override;
  std::vector<Label> output_labels() const override { return model_->output_labels(); }
  const Eigen::MatrixXd& process_noise() const override { return noise_; }
  const Eigen::MatrixXd& output_noise() const override { return model_->output_noise(); }
  double interval() const override { return model_->interval(); }
  void set_interval(double dt) override;

  void transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& next) override;
  void linearised_transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                             Eigen::VectorXd& next, Eigen::MatrixXd& jacobian) override;
  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& output) override;
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) override;

 private:
  Eigen::Index own() const { return own_; }
  const Eigen::VectorXd& true_input(const Eigen::VectorXd& state, const Eigen::VectorXd& input);
  void take_noise();

  std::unique_ptr<DiscreteModel> model_;
  Eigen::VectorXd deviations_;
  Eigen::Index own_;
  Eigen::MatrixXd noise_, inner_;
  Eigen::VectorXd input_, moved_input_, inner_state_, moved_;
};

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
