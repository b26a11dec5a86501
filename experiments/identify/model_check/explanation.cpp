#include "experiments/identify/model_check/explanation.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/identify/model_check/shared_residual.hpp"
#include "experiments/identify/update/updating.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using ExplanationVerdict = Explanation::Verdict;

constexpr Index large_system = 400;  // coordinates, of which a search takes seconds

// Drawn by update, no change among them.
int starts_of_search(Index coordinates) {
  return coordinates > large_system ? 2 : 4;
}

// Several changes together have several minima: every combination of no change, one half as large either way
// as is plausible, and one half as large again.
std::vector<VectorXd> grid_of_starts(const ModelCheck& check, const std::vector<std::size_t>& which,
                                     Index coordinates) {
  std::vector<VectorXd> grid{VectorXd::Zero(static_cast<Index>(which.size()))};
  if (which.size() == 1) return {};
  for (std::size_t i = 0; i < which.size(); ++i) {
    const Candidate& c = check.candidates[which[i]];
    std::vector<double> places{0.5 * c.plausible_lower, 0.5 * c.plausible_upper};
    if (coordinates <= large_system)
      places.insert(places.end(), {1.5 * c.plausible_lower, 1.5 * c.plausible_upper});
    for (std::size_t k = 0, known = grid.size(); k < known; ++k)
      for (const double place : places) {
        if (place == 0.0) continue;
        grid.push_back(grid[k]);
        grid.back()[static_cast<Index>(i)] = place;  // update keeps it within what is possible
      }
  }
  grid.erase(grid.begin());
  return grid;
}

// What the modes say of the changes.
void set_intervals(const ModelCheck& check, const SharedResidual& residual, const Updating& found,
                   Explanation& e) {
  const auto q = static_cast<Index>(e.candidates.size());
  e.deviation.resize(q), e.lower.resize(q), e.upper.resize(q);
  for (Index i = 0; i < q; ++i) {
    const Candidate& c = check.candidates[e.candidates[static_cast<std::size_t>(i)]];
    const UpdatedParameter& one = found.parameters[static_cast<std::size_t>(i)];
    e.at_limit.push_back(one.on_bound);
    e.determined.push_back(one.determined);
    e.deviation[i] = one.deviation;
    if (const double slope = found.best().fit.value.jacobian.col(i).norm();
        one.on_bound && q == 1 && slope > 0)
      e.deviation[i] = found.widening * std::abs(residual.space().slope(found.best().fit.x)[i]) / slope;
    e.lower[i] = std::max(c.lower, e.change[i] - quantile_95 * e.deviation[i]);
    e.upper[i] = std::min(c.upper, e.change[i] + quantile_95 * e.deviation[i]);
    const double most = one.determined ? e.upper[i] : e.change[i],
                 least = one.determined ? e.lower[i] : e.change[i];
    e.plausible = e.plausible && most >= c.plausible_lower && least <= c.plausible_upper;
  }
}

}  // namespace

Explanation explain(const ModelCheck& check, const std::vector<std::size_t>& which) {
  const SharedResidual residual(check, which);
  const Updating found = update(
      residual,
      {{check.settings.model_error, check.settings.shape_error}, starts_of_search(residual.model().size())},
      grid_of_starts(check, which, residual.model().size()));
  Explanation result;
  result.candidates = which;
  result.change = found.best().values;
  result.left = residual.left(found.best().fit.value);
  result.chi_square = found.best().fit.chi_square();
  result.freedom = found.freedom;
  result.starts = found.starts;
  result.reached = found.best().starts;
  if (which.size() == 2) result.correlation = found.correlation(0, 1);
  set_intervals(check, residual, found, result);
  for (std::size_t s = 1; s < found.as_well(); ++s) {
    const VectorXd apart = (found.sets[s].values - result.change).cwiseAbs();
    if ((apart.array() <= result.deviation.array()).all())
      result.reached += found.sets[s].starts;  // the same place, to what searches end at
    else if (which.size() == 1)
      result.others.push_back(found.sets[s].values[0]);
  }
  result.verdict = !found.explains()     ? ExplanationVerdict::leaves_much
                   : !found.open.empty() ? ExplanationVerdict::undetermined
                   : result.plausible    ? ExplanationVerdict::explains
                                         : ExplanationVerdict::implausible;
  return result;
}

std::pair<double, Index> described_fit(const ModelCheck& check) {
  const SharedResidual residual(check, {});
  const FitResidual::Value value = residual.at(VectorXd(), false);
  return {value.chi_square(), residual.independent(value)};
}

const char* to_string(ExplanationVerdict verdict) {
  switch (verdict) {
    case ExplanationVerdict::explains:
      return "explains";
    case ExplanationVerdict::implausible:
      return "explains, but implausible";
    case ExplanationVerdict::undetermined:
      return "not determined by these modes";
    default:
      return "does not explain";
  }
}

}  // namespace beamid::experiments
