// What of a record belongs to a part of the structure.
#pragma once

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
