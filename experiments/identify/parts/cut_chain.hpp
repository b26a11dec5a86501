// A chain as long as the part that is asked about.
#pragma once

#include "experiments/config/experiment.hpp"
#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
