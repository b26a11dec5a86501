// The part of a starter file that describes a structure other than a beam.
#pragma once

#include <vector>

namespace beamid::apps {

struct StructureStarter {
  const char* name;   ///< of --structure
  const char* text;   ///< its tables
  const char* place;  ///< the keys of a place on it, for an excitation and a channel
};

const std::vector<StructureStarter>& structure_starters();

}  // namespace beamid::apps
