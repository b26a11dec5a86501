#include "experiments/identify/model_check/model_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <Eigen/QR>

#include "experiments/identify/model_check/shared_residual.hpp"
#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/modal/study/mode_objections.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

// Records that contradict each other.

double apart(double a, double b) {
  return std::abs(std::log(a / b));
}

/// The matched mode that a stray stands in the place of: nearest, within a factor of 2, in none of the
/// stray's own records.
const CheckedMode* in_place_of(const ObservedMode& stray, const std::vector<CheckedMode>& matched) {
  const CheckedMode* best = nullptr;
  for (const CheckedMode& mode : matched)
    if (!best || apart(stray.frequency_hz, mode.predicted_hz) < apart(stray.frequency_hz, best->predicted_hz))
      best = &mode;
  if (!best || apart(stray.frequency_hz, best->identified.frequency_hz) > std::log(2.0)) return nullptr;
  const auto& own = stray.records;
  const auto& others = best->identified.records;
  const bool shared = std::any_of(own.begin(), own.end(), [&](const std::string& record) {
    return std::find(others.begin(), others.end(), record) != others.end();
  });
  return shared || own.empty() || others.empty() ? nullptr : best;
}

bool explains(const Explanation& e) {
  return e.verdict == Explanation::Verdict::explains;
}

/// Whose prediction a frequency meets within 3 %; empty: nobody's.
std::string predicted_by(double frequency_hz, const ModelCheck& check, std::size_t self) {
  constexpr double near = 0.03;
  for (const CheckedMode& mode : check.modes)
    if (mode.structure != self && apart(frequency_hz, mode.predicted_hz) < near)
      return fmt::format("; {} predicts {:.4g} Hz, so the records may have been exchanged",
                         check.structures[mode.structure].name, mode.predicted_hz);
  return "";
}

/// Of one structure: a record that shows no mode where others do, but one of its own within a factor of 2 of
/// it and nearer to it than to any other, is of another beam. The fewer are named:
/// "c.csv contradicts a.csv, b.csv: mode 1 is at 19.86 Hz there and at 14.4 Hz here."
/// @param matched modes of the structure; @param strays those without a prediction; loses those that are
/// named
std::vector<std::string> contradictions_of(const std::vector<CheckedMode>& matched,
                                           std::vector<ObservedMode>& strays) {
  std::vector<std::string> sentences;
  std::erase_if(strays, [&](const ObservedMode& stray) {
    const CheckedMode* mode = in_place_of(stray, matched);
    if (!mode) return false;
    const ObservedMode *few = &stray, *many = &mode->identified;
    if (few->records.size() > many->records.size()) std::swap(few, many);
    sentences.push_back(fmt::format(
        "{} contradict{} {}: mode {} at {:.4g} Hz against {:.4g} Hz. One structure has it at one of them: "
        "another one, another mass or another clamping was recorded.",
        joined(few->records), few->records.size() > 1 ? "" : "s", joined(many->records), mode->number,
        few->frequency_hz, many->frequency_hz));
    return true;
  });
  return sentences;
}

/// Modes of structures that are far off their prediction leave the check where more than half of the
/// structures are not; the contradictions name them, and whose prediction they meet.
void set_far_structures_aside(ModelCheck& check) {
  std::vector<std::size_t> far, near;
  for (std::size_t s = 0; s < check.structures.size(); ++s) {
    const auto off = [&](const CheckedMode& mode) { return mode.structure == s && mode.far; };
    const auto own = [&](const CheckedMode& mode) { return mode.structure == s; };
    if (std::any_of(check.modes.begin(), check.modes.end(), off))
      far.push_back(s);
    else if (std::any_of(check.modes.begin(), check.modes.end(), own))
      near.push_back(s);
  }
  if (far.empty() || far.size() >= near.size()) return;
  for (const CheckedMode& mode : check.modes)
    if (mode.far)
      check.contradictions.push_back(fmt::format(
          "{} contradicts the others and is excluded: mode {} predicted at {:.4g} Hz and found at {:.4g} "
          "Hz{}.",
          check.structures[mode.structure].name, mode.number, mode.predicted_hz, mode.identified.frequency_hz,
          predicted_by(mode.identified.frequency_hz, check, mode.structure)));
  std::erase_if(check.modes, [&](const CheckedMode& mode) {
    return std::find(far.begin(), far.end(), mode.structure) != far.end();
  });
}

/// Of three structures or more that no single change explains: the one without which the others are as
/// described or one plausible change explains them; nothing where there is none or more than one.
std::optional<Outlier> outlier_of(const ModelCheck& check) {
  if (check.right || check.structures.size() < 3 ||
      std::any_of(check.single.begin(), check.single.end(), explains))
    return std::nullopt;
  std::optional<Outlier> only;
  for (std::size_t s = 0; s < check.structures.size(); ++s) {
    ModelCheck others = check;
    std::erase_if(others.modes, [&](const CheckedMode& mode) { return mode.structure == s; });
    if (others.modes.size() == check.modes.size() || others.modes.size() < 2) continue;
    const auto [chi_square, numbers] = described_fit(others);
    const bool right = chi_square <= chi_square_limit(static_cast<double>(numbers));
    std::optional<Explanation> best;
    for (std::size_t c = 0; !right && c < check.candidates.size(); ++c) {
      const Explanation one = explain(others, {c});
      if (explains(one) && (!best || one.chi_square < best->chi_square)) best = one;
    }
    if (!right && !best) continue;
    if (only) return std::nullopt;
    only = Outlier{s, best};
  }
  return only;
}

// Which identified mode belongs to which predicted one.

inline constexpr double modes_apart = 0.3;  ///< of identified and predicted frequency, |ln|

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double farthest = std::numbers::ln2;  // of the lowest mode, where nothing is nearer: a factor of 2
constexpr double least_alike = 0.5;             // MAC
constexpr double impossible = -1e3, certainly = 1e3;
constexpr Index most_checked_modes = 15;

double ln_apart(double identified, double predicted) {
  return std::abs(std::log(identified / predicted));
}

Index first_vibrating(const VectorXd& frequency) {
  Index rigid = 0;
  while (rigid < frequency.size() && frequency[rigid] == 0.0) ++rigid;
  return rigid;
}

/// Taken for the lowest mode although it is beyond 30 %.
bool is_far_match(const ObservedMode& mode, const VectorXd& predicted, Index k) {
  const double apart = ln_apart(mode.frequency_hz, predicted[k]);
  return k == first_vibrating(predicted) && apart >= modes_apart && apart < farthest &&
         (k + 1 >= predicted.size() || ln_apart(mode.frequency_hz, predicted[k + 1]) > 2 * apart);
}

/// Scores of update as far as modes are near enough, then one column for each mode that stays alone.
MatrixXd matching_scores(const CheckedStructure& structure, const PredictedModes& predicted,
                         const ModalData& data, const MatrixXd& assurances) {
  const auto count = static_cast<Index>(structure.modes.size()), known = predicted.frequency_hz.size();
  MatrixXd scores = MatrixXd::Constant(count, known + count, -modes_apart);
  scores.leftCols(known) = pairing_scores(data, predicted, assurances);
  for (Index i = 0; i < count; ++i)
    for (Index k = 0; k < known; ++k) {
      const ObservedMode& mode = structure.modes[static_cast<std::size_t>(i)];
      const bool near = ln_apart(mode.frequency_hz, predicted.frequency_hz[k]) < modes_apart,
                 far = is_far_match(mode, predicted.frequency_hz, k);
      if (mode.number)
        scores(i, k) = *mode.number == k + 1 ? certainly : impossible;
      else if (predicted.frequency_hz[k] == 0.0 || !(near || far) || assurances(i, k) < least_alike)
        scores(i, k) = impossible;
      else if (far)
        scores(i, k) = -0.99 * modes_apart;
    }
  return scores;
}

/// Adds a structure's modes, strays and contradictions to the check, by the scores of update
/// (mode_pairing.hpp).
void match_modes(const CheckedStructure& structure, std::size_t number, ModelCheck& check) {
  const std::vector<fem::Point> points = points_of_shapes(structure);
  Index last = most_checked_modes;
  ModalData data{structure.name, {}};
  for (const ObservedMode& mode : structure.modes) {
    data.modes.push_back(as_measured(mode, points.size(), mode.number));
    last = std::max<Index>(last, mode.number.value_or(0));
  }
  const CauseModel model(structure.structure, structure.elements, points, {}, last);
  for (const ObservedMode& mode : structure.modes)
    if (mode.number && *mode.number > model.modes())
      throw std::invalid_argument("mode " + std::to_string(*mode.number) + " of a structure that has " +
                                  std::to_string(model.modes()) + "; expected no more than it has");
  const PredictedModes predicted = model.at(VectorXd(), false);
  const VectorXd& frequency = predicted.frequency_hz;
  const VectorXd damping = std::holds_alternative<fem::Undamped>(structure.damping)
                               ? VectorXd::Constant(frequency.size(), CheckedMode::unknown)
                               : fem::damping_ratios(structure.damping, 2.0 * std::numbers::pi * frequency);
  const MatrixXd assurances = modal_assurances(data, predicted);
  const std::vector<Index> pairs = best_assignment(matching_scores(structure, predicted, data, assurances));
  std::vector<CheckedMode> found;
  std::vector<ObservedMode> strays;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Index k = pairs[i];
    const ObservedMode& mode = structure.modes[i];
    if (k < frequency.size())
      found.push_back({number, static_cast<int>(k) + 1, frequency[k], damping[k], mode,
                       assurances(static_cast<Index>(i), k), is_far_match(mode, frequency, k)});
    else
      strays.push_back(mode);
  }
  std::sort(found.begin(), found.end(),
            [](const CheckedMode& a, const CheckedMode& b) { return a.number < b.number; });
  check.modes.insert(check.modes.end(), found.begin(), found.end());
  std::vector<std::string> sentences = contradictions_of(found, strays);
  check.contradictions.insert(check.contradictions.end(), sentences.begin(), sentences.end());
  for (ObservedMode& stray : strays) check.strays.emplace_back(number, std::move(stray));
}

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
        check.strays.size(), 100 * modes_apart));
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

std::vector<ObservedMode> observed_modes(const std::vector<RecordModes>& records) {
  std::vector<ObservedMode> observed;
  for (const MergedMode& mode : merge_modes(records)) {
    ObservedMode one{
        mode.frequency_hz.mean, std::fmax(mode.frequency_hz.deviation, mode.frequency_hz.scatter),
        mode.damping_ratio.mean, std::fmax(mode.damping_ratio.deviation, mode.damping_ratio.scatter)};
    for (std::size_t r = 0; r < records.size(); ++r) {
      if (mode.places[r] < 0) continue;
      if (one.records.empty()) one.shape = records[r].modes[mode.places[r]].pole.shape;
      one.records.push_back(records[r].name);
    }
    observed.push_back(std::move(one));
  }
  return observed;
}

}  // namespace beamid::experiments
