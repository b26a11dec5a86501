// Modes from the frequency responses of hammer records, all hits of all records together.
#pragma once

#include <string>
#include <vector>

#include "experiments/modal/hammer_response.hpp"
#include "experiments/modal/residue_fit.hpp"
#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// A mode of frequency responses. Deviations are NaN where unknown.
struct HammerMode {
  Pole pole;                 ///< shape: residues, scaled to 1 at the largest
  std::vector<int> orders;   ///< at which it was stable; none for one taken from its peak
  std::vector<double> mass;  ///< (p) 1 / (2 w_d |R|) [kg]: the modal mass where channel o is the hit's place;
                             ///< NaN where hits are too coarse
  std::vector<double> deviation;  ///< (p) [kg]
  std::vector<double> phase;  ///< (p) of 2 i w_d R: 0 or pi for a real mode, pi where the sensor is opposed
  bool complex = false;       ///< a phase more than 30 degrees from both: the masses say nothing
};

struct HammerStudy {
  std::vector<std::string> names;  ///< of the records
  std::vector<Channel> channels;   ///< p, without the force
  HammerResponses responses;       ///< all lines
  std::pair<double, double> band_hz;
  Eigen::Index first = 0, lines = 0;  ///< of the band
  std::string estimator;
  int power = 2;  ///< derivatives in the responses
  std::vector<OrderPoles> orders;
  Stabilisation stabilisation;
  ResidueFit fit;
  double misfit = 0;  ///< of the responses in the band, relative
  std::vector<HammerMode> modes;
  std::vector<std::string> remarks, warnings;  ///< sentences
  std::vector<std::string> record_warnings;    ///< of the records, with their names
};

/// Without a band: up to where the force's spectrum has fallen to a tenth, or the response's to a twentieth.
/// @throws std::invalid_argument when records, band and orders do not fit.
HammerStudy study_hits(const std::vector<std::string>& names, const std::vector<Record>& records,
                       const ModalStudySettings& settings);

}  // namespace beamid::experiments
