#include "experiments/identify/update/updating.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/identify/update/determined.hpp"
#include "experiments/text/countdown.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double same_set = 1e-4;  // in every coordinate

double no_worse(double chi_square) {
  return chi_square + 1e-6 * (1.0 + chi_square);
}

// Fits that ended at the same place, by rising chi^2.
std::vector<ParameterSet> distinct_sets(std::vector<std::optional<Fit>> fits, std::size_t starts,
                                        const SearchSpace& space, Updating& result) {
  std::vector<ParameterSet> sets;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (fits[i])
      order.push_back(i);
    else if (i < starts)
      ++result.failed;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return fits[a]->chi_square() < fits[b]->chi_square();
  });
  for (const std::size_t i : order) {
    const auto same = std::find_if(sets.begin(), sets.end(), [&](const ParameterSet& set) {
      return (set.fit.x - fits[i]->x).cwiseAbs().maxCoeff() < same_set;
    });
    const bool known = same != sets.end();
    ParameterSet& set = known ? *same : sets.emplace_back();
    set.starts += i < starts ? 1 : 0;
    set.seeded = set.seeded || i >= starts;
    if (known) continue;
    set.values = space.physical(fits[i]->x);
    set.fit = std::move(*fits[i]);
  }
  return sets;
}

// Those that fit as well as the best, the nearest to the description first where they fit the same.
void order_sets(std::vector<ParameterSet>& sets) {
  const double best = sets.front().fit.chi_square();
  for (ParameterSet& set : sets) set.as_well = set.fit.chi_square() - best <= as_well_chi_square;
  const auto equal_end = std::find_if(sets.begin(), sets.end(), [&](const ParameterSet& set) {
    return set.fit.chi_square() > std::max(no_worse(best), 1e-6);
  });
  std::stable_sort(sets.begin(), equal_end, [](const ParameterSet& a, const ParameterSet& b) {
    return a.fit.x.norm() < b.fit.x.norm();
  });
}

}  // namespace

std::size_t Updating::as_well() const {
  return static_cast<std::size_t>(
      std::count_if(sets.begin(), sets.end(), [](const ParameterSet& set) { return set.as_well; }));
}

bool Updating::continuum() const {
  return std::any_of(open.begin(), open.end(),
                     [](const OpenDirection& direction) { return std::isinf(direction.deviation); });
}

int default_starts(const ModesOfParameters& model) {
  if (model.dense()) return model.size() <= 32 ? 300 : 100;
  const double work = static_cast<double>(model.size()) * static_cast<double>(model.parameters() + 10);
  return std::clamp(static_cast<int>(2e6 / work), 4, 48);
}

Updating update(const FitResidual& residual, const UpdateSettings& settings,
                const std::vector<VectorXd>& known, const Progress& progress) {
  Updating result;
  const SearchSpace& space = residual.space();
  result.starts =
      static_cast<std::size_t>(settings.starts > 0 ? settings.starts : default_starts(residual.model()));
  std::vector<std::optional<Fit>> fits(result.starts + known.size());
  Countdown countdown(progress, fits.size(), "starts");
  tbb::parallel_for(std::size_t{0}, fits.size(), [&](std::size_t i) {
    fits[i] =
        least_squares(residual, i < result.starts ? space.start(i) : space.place(known[i - result.starts]));
    countdown.count();
  });
  result.sets = distinct_sets(std::move(fits), result.starts, space, result);
  if (result.sets.empty())
    throw std::invalid_argument(
        "the structure has no modes at any of the parameters tried: its stiffness is not positive; expected "
        "other initial estimates or bounds");
  order_sets(result.sets);
  judge_parameters(residual, result);
  if (result.continuum()) {  // other ends of searches say nothing
    ParameterSet first = std::move(result.sets.front());
    for (std::size_t i = 1; i < result.sets.size(); ++i)
      if (result.sets[i].as_well) first.starts += result.sets[i].starts;
    std::erase_if(result.sets, [&](const ParameterSet& set) { return set.as_well; });
    result.sets.insert(result.sets.begin(), std::move(first));
  }
  for (std::size_t i = 0; i < result.sets.size(); ++i)
    if (!result.sets[i].as_well) result.ended_elsewhere += result.sets[i].starts;
  return result;
}

}  // namespace beamid::experiments
