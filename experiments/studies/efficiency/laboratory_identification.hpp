// One laboratory record identified, with the report that a user gets.
#pragma once

#include "experiments/studies/efficiency/laboratory_records.hpp"

namespace beamid::experiments {

struct LaboratoryIdentification {
  IdentifiedTest found;
  LaboratoryRecord record;
  Results results;  ///< of `identify`; empty where it refused
};

LaboratoryIdentification identify_laboratory_test(const LaboratoryTest& test);

}  // namespace beamid::experiments
