// How well the samples of a hammer's pulse say its momentum.
#pragma once

#include <string>
#include <vector>

#include "experiments/modal/hammer_response.hpp"

namespace beamid::experiments {

/// Of a record without an anti-alias filter the momentum interval * sum f(t_n) is off by what the pulse's
/// spectrum holds at the sampling rate f_s, 2 |F(f_s)| cos(2 pi f_s c) with c the pulse's centre. Samples
/// cannot show F(f_s); they show F below f_s / 2. A half sine, the least smooth of pulses, falls as 1 / f^2:
/// its root mean square error is 0.13 to 0.20 times q, the root mean square of |F(f)| / |F(0)| from 0.3 f_s
/// to f_s / 2, over 3 to 14 samples of its base and all places on the grid, and 0.6 q at the worst, where it
/// begins and ends on samples. 0.3 is taken for a hit and 0.2 for several. Smoother pulses err less.
///
/// A filter removes F(f_s), and whatever q is the momentum stands. A filter that cuts a short pulse's
/// spectrum rings: it leaves swings below zero beside the pulse, from sample to sample. A pulse that was
/// merely sampled has none, since a hammer does not pull.
struct HitSampling {
  double above_half = 0;  ///< samples above half of the largest
  double aliased = 0;     ///< 0.3 q, less what noise adds to q
  double ringing = 0;     ///< of the lowest swing beside the pulse, over the largest
  double noise = 0;       ///< standard deviation of what the channel shows between hits, over the largest
  double noise_n = 0;     ///< [N]
  double place = 0;       ///< of the centre on the grid of samples, 0 to 1
};

/// What makes the momentum of a hit uncertain is told above the first, and makes it useless above the second.
inline constexpr double coarse_momentum = 0.01, lost_momentum = 0.05;

/// @param force the whole channel [N]
HitSampling hit_sampling(const Eigen::VectorXd& force, const Hit& hit);

/// Whether hits of one recorder ring: on average by more than a hundredth, and by more than the lowest of
/// sixteen samples of noise, with four standard deviations for one hit.
bool hits_ring(const std::vector<HitSampling>& hits);

/// The relative error that sampling leaves in a hit's momentum, 0 where hits ring, root mean square over
/// hits; and in the mean of several, which is less but where they lie on the same place of the grid.
double unresolved_at_once(const std::vector<HitSampling>& hits);
double unresolved_on_average(const std::vector<HitSampling>& hits);

/// Says it of hits in words, with what helps; empty where their momentum is well resolved.
std::string coarse_hits(const std::vector<HitSampling>& hits, double interval);

}  // namespace beamid::experiments
