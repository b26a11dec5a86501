// Where the filter of a free decay starts.
#pragma once

#include "experiments/identify/record_identification.hpp"

namespace beamid::experiments {

/// At rest give or take the record's own amplitude; K0 from the beam, with a standard deviation of 30 %, a
/// damping ratio of 1 % with a standard deviation as large; [prior] replaces these.
/// @param beam_stiffness of the reduced beam's first mode, Meq w^2 [N/m]
filters::Gaussian first_belief(const Experiment& experiment, const Record& record,
                               const RecordIdentification& found, double beam_stiffness);

/// Takes K0 and C0 in `found.settings` from the modal analysis, as the discretisation will see them
/// (discretisation_bias.hpp), but for what [prior] states. A filter that starts within 1 % of K keeps the
/// phase of the first periods, whatever the beam; from 30 % it follows a wrong branch in one clean record of
/// fifty.
///
/// The modal analysis saw the same record. Standard deviations are 30 of its own at least, so that this
/// counts a thousandth of the record twice: of K 1 % at least, of C the whole of it.
void start_from_mode(const PriorBelief& prior, double interval, RecordIdentification& found);

}  // namespace beamid::experiments
