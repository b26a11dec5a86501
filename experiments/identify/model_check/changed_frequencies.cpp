#include "experiments/identify/model_check/changed_frequencies.hpp"

#include <algorithm>
#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

VectorXd ChangedFrequencies::left(const std::vector<std::size_t>& which, const VectorXd& change) const {
  VectorXd result(static_cast<Index>(check_.modes.size()));
  for (std::size_t s = 0; s < check_.structures.size(); ++s) {
    int count = 0;
    for (const CheckedMode& mode : check_.modes)
      if (mode.structure == s) count = std::max(count, mode.number);
    if (count == 0) continue;
    fem::Beam beam = check_.structures[s].beam;
    for (std::size_t q = 0; q < which.size(); ++q)
      beam = check_.candidates[which[q]].changed(beam, change[static_cast<Index>(q)]);
    const VectorXd frequency =
        fem::modes(fem::assemble(beam, check_.structures[s].elements), count).frequency_hz();
    for (std::size_t i = 0; i < check_.modes.size(); ++i)
      if (const CheckedMode& mode = check_.modes[i]; mode.structure == s)
        result[static_cast<Index>(i)] = std::log(mode.identified.frequency_hz / frequency[mode.number - 1]);
  }
  return result;
}

MatrixXd ChangedFrequencies::slope(const std::vector<std::size_t>& which, const VectorXd& change) const {
  constexpr double step = 1e-3;
  MatrixXd result(static_cast<Index>(check_.modes.size()), change.size());
  for (Index q = 0; q < change.size(); ++q) {
    const Candidate& candidate = check_.candidates[which[static_cast<std::size_t>(q)]];
    VectorXd above = change, below = change;
    above[q] = std::min(candidate.upper, change[q] + step * candidate.scale);
    below[q] = std::max(candidate.lower, change[q] - step * candidate.scale);
    result.col(q) = (left(which, below) - left(which, above)) / (above[q] - below[q]);
  }
  return result;
}

}  // namespace beamid::experiments
