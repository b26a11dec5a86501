// Fatigue damage of a strain history.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/config/experiment.hpp"

namespace beamid::experiments {

/// Closed cycles of a history, half ones of what does not close.
struct StrainCycle {
  double range = 0.0, mean = 0.0;
  double count = 1.0;  ///< 1, or 0.5
};

/// Rainflow counting of turning points by the four-point rule, what is left over as half cycles
/// [astm1049], [amzallag1994]. @param history (N), finite
std::vector<StrainCycle> rainflow(const Eigen::VectorXd& history);

struct FatigueDamage {
  double damage = 0.0;            ///< sum of count / N(range) [miner1945]: 1 at failure
  double equivalent_range = 0.0;  ///< constant range that does the same damage in as many cycles
  double cycles = 0.0;
  /// Of a Gaussian history of one frequency with the same variance and upward crossings of its mean,
  /// D = n (2 sqrt 2 sigma / r_0)^m Gamma(1 + m / 2) / N_0 [bendat1964]; broad bands damage less.
  double narrow_band = 0.0;
};

FatigueDamage fatigue_damage(const Eigen::VectorXd& history, const FatigueLaw& law);

}  // namespace beamid::experiments
