// Records of hammer tests in closed form, for tests.
#pragma once

#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::test {

struct StruckMode {
  double frequency_hz, ratio, mass;
};

/// A pulse peak / 2 (1 - cos(2 pi t / duration)), or a half sine, peak sin(pi t / duration).
struct Impact {
  double start, duration, peak;
  bool half_sine = false;
};

/// Force and acceleration at the point that is struck, sampled at instants, without noise: z' = p z + f is
/// solved for f of exponentials, a = f / m + Im(p^2 z) / (m w_d).
experiments::Record struck_modes(const std::vector<StruckMode>& modes, const std::vector<Impact>& impacts,
                                 double interval, Eigen::Index count);

/// With white noise on both.
experiments::Record with_noise(experiments::Record record, double force_n, double acceleration,
                               std::uint64_t seed);

}  // namespace beamid::test
