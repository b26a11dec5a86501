// When may a filter of one mode take the others for noise? Seeded trials over beams, blows and sensors.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/noise/treatment.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

struct NoiseBeam {
  std::string name;
  fem::Beam beam;
  double tip_mass_percent = 0.0;   ///< of the beam's own
  Eigen::VectorXd damping_ratios;  ///< of the modes (k), those kept being the first of them
};

struct NoiseSettings {
  std::vector<NoiseBeam> beams;
  int elements = 40;
  int modes = 3;              ///< kept in the records
  int trials = 6;             ///< per case
  double noise = 0.001;       ///< of the sensor, relative to the first mode's amplitude in what it observes
  double deflection = 0.012;  ///< of the first mode [m]
  double blow = 0.005;        ///< duration of the hammer's half sine [s]
  double interval = 0.004;    ///< [s]
  double duration = 8.0;      ///< [s]
  std::uint64_t seed = 2009;
  std::vector<double> factors{1e-2, 1e2};  ///< on R of `white`, tried beside 1
};

/// Over the trials of one case that were not lost; errors relative to the truth.
struct NoiseStatistics {
  double stiffness_mean_percent = 0.0, damping_mean_percent = 0.0;
  double stiffness_rms_percent = 0.0, damping_rms_percent = 0.0;
  double stiffness_ratio = 0.0, damping_ratio = 0.0;  ///< rms error over the deviation reported
  double normalised_square = 0.0;                     ///< mean of all that ended; 1 where consistent
  int failed = 0;  ///< trials lost: the filter failed, or K is 5 % off or more, or C 100 %
};

struct NoiseCase {
  std::size_t beam = 0;
  Blow blow = Blow::release;
  Quantity observed = Quantity::acceleration;
  int modes = 1;
  double share = 0.0;                       ///< rms of the higher modes over that of the first, at the start
  std::vector<NoiseStatistics> treatments;  ///< in the order of `treatments`
  std::vector<NoiseStatistics> factors;     ///< `white` with R times each of the factors
  double best_factor = 1.0;                 ///< the one with the least rms error of C

  const NoiseStatistics& by(Treatment treatment) const {
    return treatments[static_cast<std::size_t>(treatment)];
  }
  const NoiseStatistics& best(const NoiseSettings& settings) const;
};

struct NoiseStudy {
  NoiseSettings settings;
  std::vector<NoiseCase> cases;  ///< every beam, blow and sensor
  std::vector<NoiseCase> kept;   ///< the first beam's release again, with 1, 2, ... modes
};

/// The statistics of one case; its numbers do not depend on the other cases or the number of threads.
NoiseCase examine(const NoiseSettings& settings, std::size_t beam, Blow blow, Quantity observed, int modes);

/// Whether the other modes may be taken for noise: C within 1 % (rms), and that error within three
/// of the deviations reported.
bool harmless(const NoiseStatistics& statistics);

/// @throws std::invalid_argument when the settings are impossible
NoiseStudy study_higher_modes(const NoiseSettings& settings, const Progress& progress);

}  // namespace beamid::experiments
