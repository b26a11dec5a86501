// What `identify` makes of simulated laboratory records when it is given nothing but the beam.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/results/results.hpp"
#include "experiments/rig/virtual_rig.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

// Simulated laboratory records: a beam, a test of it and an instrument, drawn from a seed.

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

struct LaboratorySettings {
  int records = 100;
  std::uint64_t seed = 1;
};

/// Of one record. Frequency and damping ratio are right as right_frequency() and right_damping() say.
enum class LaboratoryOutcome {
  right,        ///< both, with or without a warning
  refused,      ///< refused, or wrong with a warning on the first lines; either names the cause
  unexplained,  ///< the same, but the cause is not named
  wrong         ///< a number is off and nothing on the first lines says so
};
const char* to_string(LaboratoryOutcome outcome);

/// A 95 % interval: estimate +- half_width.
struct FoundValue {
  double estimate = 0, half_width = 0;
};

struct IdentifiedTest {
  LaboratoryTest test;
  LaboratoryOutcome outcome = LaboratoryOutcome::wrong;
  bool identified = false;                         ///< there are numbers
  FoundValue frequency, ratio;                     ///< [Hz], [-]
  double least_damping = 0, greatest_damping = 0;  ///< the truth between the ends of what was identified
  double from = 0, to = 0;                         ///< those ends [s]
  std::string said;  ///< the refusal, or the first lines of the report but for the record's own; may be empty
};

/// Within 0.5 % of the truth or within 1.5 half widths (three standard deviations), the half width being 5 %
/// at most: an interval wider than that says nothing.
bool right_frequency(const FoundValue& found, double truth);

/// Within 15 % of the range of the truth, or 1.5 half widths of it, the half width being as large as the
/// estimate at most.
bool right_damping(const FoundValue& found, double least, double greatest);

struct LaboratoryRecords {
  LaboratorySettings settings;
  std::vector<IdentifiedTest> tests;
};

/// Every record written to a file and identified as `beamid identify FILE --config BEAM` does: the same
/// reader, the same choice of a window, the same preparation. The numbers do not depend on the number of
/// processors.
/// @throws std::invalid_argument when records < 1.
LaboratoryRecords laboratory_records(const LaboratorySettings& settings, const Progress& progress);

/// A table of kinds and outcomes, and one of the records that did not come out right; all of them in
/// all_records.csv.
Results report(const LaboratoryRecords& all);

/// One record of the study: what `identify` prints of it, the truth and the outcome; rig.toml, record.csv and
/// beam.toml to repeat it with.
/// @throws std::invalid_argument when the number is not one of the study's.
Results examine(const LaboratorySettings& settings, int number);

// One laboratory record identified, with the report that a user gets.

struct LaboratoryIdentification {
  IdentifiedTest found;
  LaboratoryRecord record;
  Results results;  ///< of `identify`; empty where it refused
};

LaboratoryIdentification identify_laboratory_test(const LaboratoryTest& test);

}  // namespace beamid::experiments
