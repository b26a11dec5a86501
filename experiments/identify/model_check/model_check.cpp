#include "experiments/identify/model_check/model_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/model_check/changed_frequencies.hpp"
#include "experiments/identify/model_check/contradictions.hpp"
#include "experiments/identify/model_check/explanation.hpp"
#include "experiments/signal/chi_square_limit.hpp"
#include "experiments/text/spelling.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double most_apart = 0.3;               // of identified and predicted frequency, relative
constexpr double farthest = 0.6931471805599453;  // of the lowest mode, where nothing is nearer: a factor of 2
constexpr double least_alike = 0.5;              // MAC
constexpr Index most_checked_modes = 15;

bool has_shapes(const CheckedStructure& structure) {
  const auto& channels = structure.channels;
  return channels.size() > 1 && channels[0].quantity != Quantity::strain &&
         std::all_of(channels.begin(), channels.end(),
                     [&](const Channel& c) { return c.quantity == channels[0].quantity; });
}

/// Predicted modes, each with the identified one nearest to it; an identified one belongs to one mode only.
void match(const CheckedStructure& structure, std::size_t number, ModelCheck& check) {
  const fem::Point natural = fem::natural_point(structure.beam);
  std::vector<fem::Point> points;
  if (has_shapes(structure))
    for (const Channel& channel : structure.channels)
      points.push_back({channel.name, channel.position.value_or(natural.position)});
  else
    points.push_back(natural);
  const fem::StructuralSystem system = fem::assemble(structure.beam, structure.elements, points);
  const fem::Modes modes = fem::modes(system, std::min(system.size(), most_checked_modes));
  const VectorXd predicted = modes.frequency_hz();
  const VectorXd damping = std::holds_alternative<fem::Undamped>(structure.damping)
                               ? VectorXd::Constant(predicted.size(), CheckedMode::unknown)
                               : fem::damping_ratios(structure.damping, modes.angular_frequency);
  struct Couple {
    double apart;
    Index predicted;
    std::size_t identified;
    double assurance;
  };
  std::vector<Couple> couples;
  for (Index m = modes.rigid; m < predicted.size(); ++m)
    for (std::size_t i = 0; i < structure.modes.size(); ++i) {
      const ObservedMode& mode = structure.modes[i];
      Couple couple{std::abs(std::log(mode.frequency_hz / predicted[m])), m, i, CheckedMode::unknown};
      if (has_shapes(structure) && mode.shape.size() == system.outputs.rows())
        couple.assurance =
            modal_assurance(mode.shape, (system.outputs * modes.shape.col(m)).cast<std::complex<double>>());
      const bool far = m == modes.rigid && couple.apart < farthest &&
                       (m + 1 >= predicted.size() ||
                        std::abs(std::log(mode.frequency_hz / predicted[m + 1])) > 2 * couple.apart);
      if ((couple.apart < most_apart || far) && !(couple.assurance < least_alike)) couples.push_back(couple);
    }
  std::sort(couples.begin(), couples.end(),
            [](const Couple& a, const Couple& b) { return a.apart < b.apart; });
  std::vector<bool> matched(predicted.size(), false), taken(structure.modes.size(), false);
  std::vector<CheckedMode> found;
  for (const Couple& couple : couples) {
    if (matched[couple.predicted] || taken[couple.identified]) continue;
    matched[couple.predicted] = taken[couple.identified] = true;
    found.push_back({number, static_cast<int>(couple.predicted) + 1, predicted[couple.predicted],
                     damping[couple.predicted], structure.modes[couple.identified], couple.assurance,
                     couple.apart >= most_apart});
  }
  std::sort(found.begin(), found.end(),
            [](const CheckedMode& a, const CheckedMode& b) { return a.number < b.number; });
  check.modes.insert(check.modes.end(), found.begin(), found.end());
  std::vector<ObservedMode> strays;
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (!taken[i]) strays.push_back(structure.modes[i]);
  std::vector<std::string> sentences = contradictions_of(found, strays);
  check.contradictions.insert(check.contradictions.end(), sentences.begin(), sentences.end());
  for (ObservedMode& stray : strays) check.strays.emplace_back(number, std::move(stray));
}

std::vector<Candidate> chosen(const std::vector<std::string>& names, std::vector<Candidate> possible) {
  if (names.empty()) return possible;
  std::vector<Candidate> result;
  for (const std::string& name : names) {
    const auto& known = candidate_names();
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw std::invalid_argument("unknown candidate '" + name + "'; known: " + joined(known));
    const auto at =
        std::find_if(possible.begin(), possible.end(), [&](const Candidate& c) { return c.name == name; });
    if (at == possible.end()) {
      std::vector<std::string> have;
      for (const Candidate& c : possible) have.push_back(c.name);
      throw std::invalid_argument("candidate '" + name + "' is none of this beam's; it has " + joined(have));
    }
    result.push_back(*at);
  }
  return result;
}

}  // namespace

double CheckedMode::difference() const {
  return std::log(identified.frequency_hz / predicted_hz);
}

ModelCheck check_model(std::vector<CheckedStructure> structures, const ModelCheckSettings& settings) {
  ModelCheck check{std::move(structures), settings, {}, {}, {}, {}, 0, false, {}, {}, {}, {}};
  std::vector<fem::Beam> beams;
  for (std::size_t s = 0; s < check.structures.size(); ++s) {
    match(check.structures[s], s, check);
    beams.push_back(check.structures[s].beam);
  }
  if (check.modes.empty())
    throw std::invalid_argument(fmt::format(
        "none of the {} identified modes lies within {:.0f} % of a predicted one, or within a factor of 2 of "
        "the lowest; expected one at least",
        check.strays.size(), 100 * most_apart));
  set_far_structures_aside(check);
  check.candidates = chosen(settings.candidates, candidates_of(beams));
  const ChangedFrequencies frequencies(check);
  const VectorXd variance = variances(check), differences = frequencies.left({}, VectorXd());
  check.chi_square = (differences.array().square() / variance.array()).sum();
  check.right = check.chi_square <= chi_square_limit(static_cast<double>(differences.size()));
  check.effect.resize(differences.size(), static_cast<Index>(check.candidates.size()));
  for (std::size_t c = 0; c < check.candidates.size(); ++c)
    check.effect.col(static_cast<Index>(c)) =
        frequencies.slope({c}, VectorXd::Zero(1)) * check.candidates[c].scale;
  for (std::size_t a = 0; a < check.candidates.size(); ++a) {
    check.single.push_back(explain(check, frequencies, {a}));
    for (std::size_t b = 0; b < a; ++b)
      if (differences.size() > 1) check.pairs.push_back(explain(check, frequencies, {b, a}));
  }
  for (auto* list : {&check.single, &check.pairs})
    std::stable_sort(list->begin(), list->end(), [](const Explanation& a, const Explanation& b) {
      return std::pair(a.verdict, a.chi_square) < std::pair(b.verdict, b.chi_square);
    });
  check.outlier = outlier_of(check);
  return check;
}

}  // namespace beamid::experiments
