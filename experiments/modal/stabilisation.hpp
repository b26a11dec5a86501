// Which poles stay where they are as the model order grows: those of the structure.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/modal/pole.hpp"

namespace beamid::experiments {

struct StabilisationSettings {
  double frequency_tolerance = 0.01;  ///< relative change from the order before
  double damping_tolerance = 0.1;     ///< of the damping ratio, relative
  double assurance_tolerance = 0.02;  ///< of 1 - MAC
  double cluster_distance = 0.02;     ///< |df| / f + |d damping ratio| / 2 + 1 - MAC, mean over two clusters
  double resolution_hz = 0;           ///< poles closer than that are one mode (free decay: 1 / duration)
  double largest_damping_ratio = 0.2;
  double largest_frequency_deviation = 0.02;  ///< relative, where the method knows it
  double fewest_orders = 0.3;                 ///< share of the orders at which a mode has to be stable
  std::pair<double, double> band_hz{0, 1e300};
};

enum class Stability { unstable, frequency, full };  ///< frequency only, or damping and shape too

struct DiagramPole {
  int order = 0;
  Pole pole;
  Stability stability = Stability::unstable;
};

/// A cluster of poles over orders, as one.
struct PoleCluster {
  Pole pole;
  std::vector<int> orders;  ///< where it was stable
  std::string objection;    ///< why it is no mode of the structure; empty: it is one
};

struct Stabilisation {
  std::vector<DiagramPole> poles;     ///< within the band
  std::vector<PoleCluster> modes;     ///< by rising frequency
  std::vector<PoleCluster> rejected;  ///< likewise; of three poles at least
};

/// Stabilisation diagram and its reading by hierarchical clustering with average linkage [reynders2012].
///
/// A pole is stable when the order before has one within the tolerances. A cluster, one pole of each order,
/// becomes a mode by its stable poles: medians, or means weighted by inverse variance where deviations are
/// known. The deviation is then sqrt(1 / mean(1 / variance)): poles of several orders share their data, so
/// more orders make no mode more certain.
Stabilisation stabilise(const std::vector<OrderPoles>& orders, const StabilisationSettings& settings);

}  // namespace beamid::experiments
