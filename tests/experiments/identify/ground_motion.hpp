// The motion of the ground in tests of what stands on it.
#pragma once

#include <filesystem>
#include <fstream>

#include "experiments/signal/toolbox.hpp"

namespace beamid::test {

/// Noise through a low-pass of first order, every 0.01 s.
inline void write_ground_motion(const std::filesystem::path& path, Eigen::Index samples) {
  std::ofstream file(path);
  file << "time_s,base_acceleration_m_per_s2\n";
  const Eigen::VectorXd white = experiments::standard_normal(samples, 3, 0);
  double slow = 0.0;
  for (Eigen::Index k = 0; k < white.size(); ++k)
    file << 0.01 * static_cast<double>(k) << ',' << (slow += 0.5 * (white[k] - slow)) << '\n';
}

}  // namespace beamid::test
