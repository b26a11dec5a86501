// Modes from the frequency responses of hammer records, all hits of all records together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/modal/hammer_response.hpp"
#include "experiments/modal/residue_fit.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

// The mass that a hammer feels in a mode.

/// A mode's mass at the point that is struck, m = 1 / phi^2 with phi the mass-normalised shape there.
struct HammerMass {
  double mass = 0, deviation = 0;         ///< [kg]
  double impulse = 0, velocity_step = 0;  ///< of the hit [N s], of the mode [m/s]
  std::vector<double> pulses_s;           ///< of the hit, after its onset
  std::string coarse;                     ///< what is said of a hit of few samples (hit_sampling.hpp)
};

/// From impulse and velocity step: after a force f(t) from rest the mode moves as
///
///     x(t) = Im(e^(s t) F) / (m w_d),   F = integral of f(t) e^(-s t) dt,   so   m = |s|^k |F| / (w_d A)
///
/// with A the mode's amplitude in displacement, velocity or acceleration (k = 0, 1, 2), taken back to the
/// hit: log A from the first window of its decay, with the damping rate there and its change up to the second
/// window (amplitude_dependence.hpp). The deviation is that of this way back and of what sampling leaves of F
/// (hit_sampling.hpp); the hammer's calibration is not in it.
/// @param record whole, with the force; the first channel of motion counts, taken to be where the hammer hits
/// @return nothing where the record has no force, no hit, a hit of too few samples or too short a decay;
/// `reason` says why
std::optional<HammerMass> hammer_mass(const Record& record, const Pole& pole,
                                      const std::vector<std::complex<double>>& others, std::string& reason);

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
  std::vector<std::string> remarks;
  std::vector<Objection> objections;
  std::vector<Objection> record_objections;  ///< of the records, with their names
};

/// Without a band: up to where the force's spectrum has fallen to a tenth, or the response's to a twentieth.
/// @throws std::invalid_argument when records, band and orders do not fit.
HammerStudy study_hits(const std::vector<std::string>& names, const std::vector<Record>& records,
                       const ModalStudySettings& settings);

}  // namespace beamid::experiments
