// Several beams that share parameters: lengths cut of one strip, masses set on one cantilever.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/identify/family/shared_estimate.hpp"

namespace beamid::experiments {

/// One beam, with what is asked about it, and its record.
struct FamilyMember {
  std::string name;  ///< of the experiment file
  Experiment experiment;
  std::filesystem::path folder;  ///< of the file
  std::string record_name;
  Record record;
};

struct BeamFamily {
  std::vector<FamilyMember> members;
  std::vector<Comparison> alone;       ///< each at the shared estimate, one run
  SharedEstimate estimate;             ///< of what the filters' states carry
  std::vector<Estimate> parameters;    ///< at it (Q)
  std::vector<std::string> shared_by;  ///< of every parameter: names of its beams, comma-separated (Q)
  int rounds = 0;                      ///< of relinearisation
  bool settled = false;  ///< whether the last round moved no parameter by a tenth of its deviation
};

/// Parameters of one name are one parameter; each member may have others of its own. Every record is
/// identified by itself, what each says is added up (shared_estimate()), and all are identified anew from the
/// sum, so that a record that determines but a combination of its unknowns is linearised where the others put
/// it (Gauss and Newton), until it stays, or six times.
/// @throws std::invalid_argument where nothing is shared, a shared parameter has another form or unit in
/// another file, or a record is not identified; InputError as compare()
BeamFamily identify_family(std::vector<FamilyMember> members, const Progress& progress);

}  // namespace beamid::experiments
