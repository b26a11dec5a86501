// Simulated free decays whose stiffness and damping are known, and how well any estimator can find them.
#pragma once

#include "experiments/models/joint_model.hpp"
#include "experiments/models/oscillator.hpp"
#include "filters/discrete_model.hpp"
#include "filters/monte_carlo.hpp"

namespace beamid::experiments {

/// How the first guesses of K and C are chosen: each from half to twice the truth.
enum class Guess {
  drawn,  ///< uniformly in the logarithm, independently
  ends    ///< half or twice, the four pairs in turn
};

struct DecaySettings {
  double damping_ratio = 0.01;
  double mass = 1.0;          ///< M [kg], known
  double frequency_hz = 4.0;  ///< undamped
  double amplitude = 0.01;    ///< of the displacement at the first sample [m]
  double phase = 0.7;         ///< of the first sample [rad]: neither at rest nor at an end
  double noise = 0.02;        ///< deviation of the displacement's white noise, as a share of the amplitude
  double samples_per_cycle = 25;
  double cycles = 30;         ///< length of the record, unless it has died out before
  double time_constants = 4;  ///< after so many of 1/(xi w) it has
  Guess guess = Guess::drawn;
};

/// x(t) = Re(a e^(lambda t)) read N times with white noise; model sdof, [x, v, K, C], displacement observed.
class FreeDecays {
 public:
  /// @throws std::invalid_argument where damping ratio is not in (0, 1), a number is not positive, or fewer
  /// than 16 samples are left.
  explicit FreeDecays(const DecaySettings& settings);

  const DecaySettings& settings() const { return settings_; }
  const Oscillator& truth() const { return truth_; }
  Eigen::Index samples() const { return samples_; }  ///< N
  double interval() const { return interval_; }      ///< [s]
  /// Cramer-Rao bound of the deviations of K and C: initial state unknown too, no prior (2).
  const Eigen::Vector2d& bound() const { return bound_; }

  /// The model, sampled exactly, with the noise as it is.
  std::unique_ptr<filters::DiscreteModel> model() const;
  /// A noisy record, and a first estimate: at rest, deviations of x and v twice what the largest reading may
  /// mean, K and C at the guess with deviations of 3/4 and 1 of it. The same seed gives the same trial.
  filters::Trial trial(std::uint64_t seed) const;

 private:
  Eigen::Vector2d guess_factors(std::uint64_t seed) const;

  DecaySettings settings_;
  Oscillator truth_;
  std::shared_ptr<const filters::ContinuousModel> motion_;
  double interval_ = 0.0;
  Eigen::Index samples_ = 0;
  Eigen::VectorXd decay_;  // x without noise (N)
  Eigen::Vector2d bound_;
};

}  // namespace beamid::experiments
