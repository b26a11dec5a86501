// Stiffness and damping of one beam from several records of it: `beamid identify RECORD RECORD...`.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/joint_estimate.hpp"
#include "experiments/identify/record_identification.hpp"

namespace beamid::experiments {

/// One of the records, and what it alone says.
struct IdentifiedRecord {
  std::string name;  ///< as shown
  Record record;
  RecordIdentification found;

  bool lost() const;  ///< whether the filter lost its motion
};

/// What all records say together.
struct JointIdentification {
  std::vector<IdentifiedRecord> records;
  JointEstimate estimate;         ///< of K and C, by the records that are not lost; empty: all are
  Identification identification;  ///< at it, without a run; deviations of the estimate
};

/// Each record has been identified by itself: own start, noise and window; beam, model and prior are shared.
/// @throws std::invalid_argument when equivalent masses differ.
JointIdentification joint_identification(std::vector<IdentifiedRecord> records);

}  // namespace beamid::experiments
