// What `identify` makes of simulated laboratory records when it is given nothing but the beam.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/results/results.hpp"
#include "experiments/studies/efficiency/simulated_laboratory.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

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
