// Several beams that share parameters: lengths cut of one strip, masses set on one cantilever.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/joint_comparison.hpp"

namespace beamid::experiments {

// Records that share some of their unknowns.

/// What one record says of the unknowns that its own model has.
struct NamedEstimate {
  std::vector<std::string> names;  ///< of its unknowns (q_r)
  RecordEstimate estimate;         ///< nuisance, start and prior included
};

struct SharedEstimate {
  std::vector<std::string> names;  ///< of all unknowns, in the order of their first appearance (Q)
  filters::Gaussian unknowns;      ///< deviations include Birge's ratio where the records disagree (Q)
  double chi_squared = 0;          ///< of the records about the shared estimate
  double freedom = 0;              ///< what the records determine beyond the Q unknowns
  double probability = 1;          ///< of one as large where the records agree
  double scatter = 1;              ///< Birge's ratio; 1 where they agree
};

/// As joint_estimate() with unknowns that belong together by their names: with E_r picking those of record r,
///
///     I = sum_r E_r^T I_r E_r + N,   I_r = (P_r^-1 - P0_r^-1) / k_r^2,   m = I^-1 (sum_r E_r^T I_r m_r + N
///     m_0), chi^2 = sum_r (m_r - E_r m)^T I_r (m_r - E_r m)
///
/// k_r being the noise ratio of the record, N what is known beforehand: of nuisance unknowns what their prior
/// says, once; of the others 1e-8 of it, so that what no record says anything of remains as uncertain as
/// before. A single record need not determine its own unknowns: I_r may be singular.
/// @throws std::invalid_argument without records.
SharedEstimate shared_estimate(const std::vector<NamedEstimate>& records);

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
