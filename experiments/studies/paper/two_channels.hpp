// What the innovations show of forward Euler: nothing on one channel, the ratio of two on two.
//
// The parameters found make the eigenvalue right and with it one history. The mode's shape (x, v) is then
// that of lambda_f and not of lambda, and |v|/|x| wrong by w dt / 2: seen where R is the sensors', hidden
// where R is large.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/table.hpp"
#include "experiments/studies/paper/beam_identification.hpp"

namespace beamid::experiments::paper {

/// One released oscillator with noise on both channels, R that of the noise unless said, by two schemes.
struct ChannelCase {
  std::string motion;                                       ///< "table 2" or a beam
  std::string observed;                                     ///< "x" or "x and v"
  double displacement_noise = 0.0;                          ///< standard deviation [m]
  double velocity_noise = 0.0;                              ///< [m/s]
  double assumed_variance = 0.0;                            ///< R of both; 0: that of the noise
  double euler_square = 0.0, exact_square = 0.0;            ///< mean NIS over the outputs
  double euler_correlation = 0.0, exact_correlation = 0.0;  ///< of displacement's innovations, lag one
};

/// @param beam whose first mode is looked at beside the oscillator of table 2
std::vector<ChannelCase> examine_channels(const BeamCase& beam, std::uint64_t seed);

Table channel_table(const std::vector<ChannelCase>& cases);

}  // namespace beamid::experiments::paper
