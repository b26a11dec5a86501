// A structure identified part by part.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"

namespace beamid::experiments {

// A span of a beam between measured sections.

/// The unknowns of a span by the lines of its record's spectrum (line_likelihood.hpp): a comparison of one
/// run. Contradicted where its sensors move otherwise than the sections make it, diverged where no maximum is
/// found.
/// @param experiment experiment_of_part(); @param record record_of_part(); @param highest_hz of its lines;
/// absent: as record_lines()
/// @throws std::invalid_argument where stamps are uneven, readings are missing or the noise of a sensor
/// inside is not stated.
Comparison identify_span(const Experiment& experiment, ComparedRecord record,
                         const std::optional<double>& highest_hz = {});

// What of a record belongs to a part of the structure.

/// Whether the noise of the motion at the sections counts.
enum class Sections {
  exact,  ///< as if what was measured there were the motion itself [koh1991]
  noisy   ///< its noise is part of the state (filters/latent_inputs.hpp)
};

/// Whether parts are spans of a beam, which bends: a section passes on a deflection and a rotation.
bool has_spans(const fem::Structure& structure);

/// The channels of a part: accelerations at its sections become support_acceleration, those inside stay as
/// they are, and so do forces inside and, where the part stands on the base, the base's acceleration. All
/// else is left out: it acts through the sections alone. Of a span angular accelerations at the sections
/// become support_angular_acceleration; where one is missing, a channel of zeros with infinite noise takes
/// its place.
/// @param record every channel knows its place
/// @throws InputError at the part's place where no accelerometer sits at one of its sections or none inside,
/// or, of noisy sections, where their noise is not stated; of a span also where the base moves, or more
/// rotations are missing than accelerometers inside can make up for.
ComparedRecord record_of_part(const Experiment& experiment, const ComparedRecord& record,
                              const PartOfStructure& part, Sections sections);

/// The experiment as asked about the part: in its own coordinates, of the parameters those that it has.
/// @throws InputError where none of them is its own, or one is of modes, which are those of the whole.
Experiment experiment_of_part(const Experiment& experiment, const ComparedRecord& part_record,
                              const PartOfStructure& part);

// A chain as long as the part that is asked about.

/// A part of a chain, and of the storeys beyond its sections none but the one below, on which the lower
/// section stands. Places are heights above that storey's foot, names stay. What is done with a part then
/// takes the time that the part takes, however many storeys the chain has.
struct CutChain {
  Experiment experiment;
  ComparedRecord record;
  PartOfStructure part;
};

/// @param record record_of_part()
/// @returns the same as was given where the structure is no chain, hangs on springs to the ground, or where
/// one of the parameters spans a section, or all storeys.
CutChain cut_chain(const Experiment& experiment, ComparedRecord record, const PartOfStructure& part);

struct IdentifiedPart {
  PartOfStructure part;
  Comparison exact, noisy;  ///< one run each: sections taken for exact, and with their noise

  const ComparedRun& run(Sections sections) const {
    return (sections == Sections::exact ? exact : noisy).runs.front();
  }
  /// With the noise at its sections counted: only then it has an estimate that is joined.
  bool converged() const { return run(Sections::noisy).answers(); }
};

/// A parameter as all parts say together, weighed by their covariances.
struct JoinedParameter {
  std::string name, unit;
  double value = 0.0, deviation = 0.0;  ///< [unit]
  int parts = 0;
  double disagreement = 0.0;  ///< of the parts, the largest difference over its own deviation
  std::optional<double> truth;
};

struct PartedIdentification {
  std::vector<IdentifiedPart> parts;
  std::optional<Comparison> whole;  ///< of one run; absent where it was not asked for
  std::vector<JoinedParameter> joined;
  std::string no_whole;  ///< why not

  bool converged() const;  ///< every part, the noise at its sections counted
};

/// As simulated_record(). @throws InputError at the first part where parts are spans: a simulated record is
/// sampled without a filter against aliasing, and has the modes below half the sampling rate only or those
/// above at other frequencies.
ComparedRecord simulated_for_parts(const Experiment& truth, const std::filesystem::path& folder,
                                   const Progress& progress);

/// Every part of the experiment on its share of the record, two at a time, and the whole beside them where it
/// has no more than 30 coordinates.
///
/// Neighbours share the noise of the sensors between them, which is counted as if it were of two sensors:
/// their estimates of a common parameter are a little less independent than the joined deviation says.
/// @param whole also identify the whole structure with all channels
/// @throws InputError as record_of_part() and compare()
PartedIdentification identify_parts(const Experiment& experiment, const ComparedRecord& record,
                                    const std::filesystem::path& folder, bool whole,
                                    const Progress& progress);

}  // namespace beamid::experiments
