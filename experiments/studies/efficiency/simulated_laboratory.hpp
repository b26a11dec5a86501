// Simulated laboratory records: a beam, a test of it and an instrument, drawn from a seed.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/rig/virtual_rig.hpp"

namespace beamid::experiments {

/// What a laboratory does to a record.
enum class LaboratoryKind {
  plain,      ///< noise and higher modes alone
  jitter,     ///< stamps with a jitter of 30 %, whose median interval is 1.5 to 12 % shorter than the mean
  gaps,       ///< one to four of 10 ms to 0.3 s
  repeated,   ///< 4 % of the samples
  clipping,   ///< at 0.35 to 0.8 of the largest reading
  coarse,     ///< steps of 0.4 to 4 % of the largest reading
  dead,       ///< a second channel shows nothing, before the good one or behind it
  drift,      ///< an offset of up to the largest reading, drifting by up to 0.4 of it
  startup,    ///< of 0.5 to 3 times the largest reading, fading in 0.05 to 0.4 s
  rattle,     ///< noise of 5 to 30 % of the largest reading, where that is beyond 30 to 60 % of it
  amplitude,  ///< damping that falls with the amplitude, from up to 0.9 to 0.2 %, by air drag
  by_hand,    ///< a release within 0.3 to 1.1 periods
};
inline constexpr int laboratory_kinds = 12;

const char* to_string(LaboratoryKind kind);

/// Words of which a refusal or a warning must hold one to have named the cause.
const std::vector<std::string>& cause_words(LaboratoryKind kind);

/// One test. The first kind is record number modulo the number of kinds; each of the others joins in one
/// record of eight (a dead channel in none).
struct LaboratoryTest {
  int number = 0;
  std::vector<LaboratoryKind> kinds;
  std::string rig;   ///< experiment file of the simulation
  std::string beam;  ///< experiment file that says nothing but the beam, as described, and the sensor's place
  double frequency_hz = 0;       ///< of the true beam's first mode
  double least_damping = 0;      ///< damping ratio of the first mode at small amplitudes
  double damping_per_metre = 0;  ///< and its growth with the amplitude of the tip [1/m]
};

/// @param seed of the study; every number has its own stream of it.
LaboratoryTest laboratory_test(std::uint64_t seed, int number);

/// The record of a test, written as `beamid simulate` writes it, and how the tip moved in truth.
struct LaboratoryRecord {
  Record record;
  double event = 0;              ///< when the motion began [s]
  Eigen::VectorXd time, motion;  ///< of the tip: (N) [s] on the record's clock, (N) [m]
};

/// @throws InputError where the test's own file is wrong.
LaboratoryRecord simulate(const LaboratoryTest& test);

/// Least and greatest damping ratio of the first mode between two instants of the record.
std::pair<double, double> damping_between(const LaboratoryTest& test, const LaboratoryRecord& record,
                                          double from, double to);

}  // namespace beamid::experiments
