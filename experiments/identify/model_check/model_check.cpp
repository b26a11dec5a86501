#include "experiments/identify/model_check/model_check.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "experiments/identify/model_check/contradictions.hpp"
#include "experiments/identify/model_check/explanation.hpp"
#include "experiments/identify/model_check/matching.hpp"
#include "experiments/identify/model_check/shared_residual.hpp"
#include "experiments/signal/chi_square_limit.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t most_fitted_pairs = 45;  // all of ten candidates

std::vector<Candidate> chosen(const std::vector<std::string>& names, std::vector<Candidate> possible) {
  if (names.empty()) return possible;
  std::vector<Candidate> result;
  for (const std::string& name : names) {
    const auto at =
        std::find_if(possible.begin(), possible.end(), [&](const Candidate& c) { return c.name == name; });
    if (at == possible.end()) {
      std::vector<std::string> have;
      for (const Candidate& c : possible) have.push_back(c.name);
      throw std::invalid_argument("unknown candidate '" + name + "'; known: " + joined(have));
    }
    result.push_back(*at);
  }
  return result;
}

/// The residual as described and what each candidate does to it, in units of its scale.
struct FirstOrder {
  VectorXd residual;  ///< (r)
  MatrixXd slopes;    ///< (r x c)
};

FirstOrder first_order(ModelCheck& check) {
  FirstOrder result;
  const auto count = static_cast<Index>(check.candidates.size());
  check.effect.resize(static_cast<Index>(check.modes.size()), count);
  for (Index c = 0; c < count; ++c) {
    const SharedResidual residual(check, {static_cast<std::size_t>(c)});
    const FitResidual::Value value = residual.at(VectorXd::Zero(1), true);
    if (c == 0) result.slopes.resize(value.residual.size(), count), result.residual = value.residual;
    result.slopes.col(c) = value.jacobian.col(0);
    check.effect.col(c) =
        residual.effect(value) * check.candidates[static_cast<std::size_t>(c)].plausible_upper;
  }
  const MatrixXd directions = result.slopes.colwise().normalized();
  check.alike = directions.transpose() * directions;
  return result;
}

/// Of a sum of squares: causes that are one and the same to these modes differ by rounding only, and stay in
/// the order of the catalogue.
double rank_of(double squares) {
  constexpr double same = 1e-6;  // in ln
  return std::round(std::log(squares) / same);
}

/// Those that come nearest at first order; all where there are few.
std::vector<std::vector<std::size_t>> pairs_to_fit(const FirstOrder& at, ModelCheck& check) {
  std::vector<std::pair<double, std::vector<std::size_t>>> pairs;
  for (std::size_t a = 0; a < check.candidates.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      MatrixXd both(at.residual.size(), 2);
      both << at.slopes.col(static_cast<Index>(b)), at.slopes.col(static_cast<Index>(a));
      const VectorXd left = at.residual - both * both.completeOrthogonalDecomposition().solve(at.residual);
      pairs.push_back({rank_of(left.squaredNorm()), {b, a}});
    }
  check.possible_pairs = pairs.size();
  if (pairs.size() > most_fitted_pairs) {
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    pairs.resize(most_fitted_pairs);
  }
  std::vector<std::vector<std::size_t>> result;
  for (auto& [rank, pair] : pairs) result.push_back(std::move(pair));
  return result;
}

std::vector<Explanation> explanations(const ModelCheck& check,
                                      const std::vector<std::vector<std::size_t>>& causes) {
  std::vector<Explanation> all(causes.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) { all[i] = explain(check, causes[i]); });
  std::stable_sort(all.begin(), all.end(), [](const Explanation& a, const Explanation& b) {
    return std::pair(a.verdict, rank_of(a.chi_square)) < std::pair(b.verdict, rank_of(b.chi_square));
  });
  return all;
}

}  // namespace

double CheckedMode::difference() const {
  return std::log(identified.frequency_hz / predicted_hz);
}

bool CheckedMode::paired_by_shape() const {
  return std::isfinite(assurance) && !far && !identified.number;
}

ModelCheck check_model(std::vector<CheckedStructure> structures, const ModelCheckSettings& settings) {
  ModelCheck check{std::move(structures), settings};
  std::vector<fem::Structure> described;
  for (std::size_t s = 0; s < check.structures.size(); ++s) {
    match_modes(check.structures[s], s, check);
    described.push_back(check.structures[s].structure);
  }
  if (check.modes.empty())
    throw std::invalid_argument(fmt::format(
        "none of the {} identified modes lies within {:.0f} % of a predicted one, or within a factor of 2 of "
        "the lowest; expected one at least",
        check.strays.size(), 100 * most_apart));
  set_far_structures_aside(check);
  check.candidates = chosen(settings.candidates, candidates_of(described));
  std::tie(check.chi_square, check.numbers) = described_fit(check);
  check.right = check.chi_square <= chi_square_limit(static_cast<double>(check.numbers));
  const FirstOrder at = first_order(check);
  std::vector<std::vector<std::size_t>> alone;
  for (std::size_t c = 0; c < check.candidates.size(); ++c) alone.push_back({c});
  check.single = explanations(check, alone);
  const std::vector<std::vector<std::size_t>> pairs = pairs_to_fit(at, check);
  const bool explained = check.right || check.single.front().verdict == Explanation::Verdict::explains;
  if (check.modes.size() > 1 && (!explained || pairs.size() == check.possible_pairs))
    check.pairs = explanations(check, pairs);
  check.outlier = outlier_of(check);
  return check;
}

}  // namespace beamid::experiments
