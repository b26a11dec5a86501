// Records that share some of their unknowns.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/joint_estimate.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
