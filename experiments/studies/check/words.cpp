#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "experiments/identify/update/updating.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/studies/check/report.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using ExplanationVerdict = Explanation::Verdict;
using Explanations = std::vector<const Explanation*>;

constexpr const char* alike_note =
    "Another mode, another sensor, or the same structure with another mass on it, may show more.";

const Candidate& candidate_in(const ModelCheck& check, const Explanation& e, std::size_t i = 0) {
  return check.candidates[e.candidates[i]];
}

/// "tip mass +0.05 kg (95 %: +0.03 to +0.07)"; of what is not determined no interval.
std::string change_text(const ModelCheck& check, const Explanation& e) {
  std::string text;
  for (std::size_t i = 0; i < e.candidates.size(); ++i) {
    const Candidate& c = candidate_in(check, e, i);
    const double shown = c.unit == "%" ? 100 : 1;
    text += fmt::format("{}{} {:+.3g} {}", i > 0 ? " with " : "", c.label, shown * e.change[i], c.unit);
    if (!e.determined[i])
      text += " (not determined by these modes)";
    else if (e.at_limit[i])
      text += " (on its bound)";
    else
      text += fmt::format(" (95 %: {:+.3g} to {:+.3g})", shown * e.lower_95(i), shown * e.upper_95(i));
    for (const double other : e.others) text += fmt::format(", or {:+.3g} {} as well", shown * other, c.unit);
  }
  return text;
}

Explanations with(const std::vector<Explanation>& all, ExplanationVerdict verdict) {
  Explanations found;
  for (const Explanation& one : all)
    if (one.verdict == verdict) found.push_back(&one);
  return found;
}

std::string names_of(const ModelCheck& check, const Explanations& some) {
  std::vector<std::string> names;
  for (const Explanation* one : some) {
    std::string name = candidate_in(check, *one).label;
    if (one->candidates.size() > 1) name += " with " + candidate_in(check, *one, 1).label;
    names.push_back(std::move(name));
  }
  return joined(names);
}

/// Those as good as the best, and those that explain too but are less likely by a factor of 20: update's
/// rule.
std::pair<Explanations, Explanations> parted_by_likelihood(Explanations explains) {
  const auto worse = std::find_if(explains.begin(), explains.end(), [&](const Explanation* e) {
    return e->chi_square - explains.front()->chi_square > as_well_chi_square;
  });
  return {Explanations(explains.begin(), worse), Explanations(worse, explains.end())};
}

/// What explains among one kind, single or pairs; whether anything plausible does.
bool add_conclusions(const ModelCheck& check, const std::vector<Explanation>& all, const char* kind,
                     const char* kinds, std::vector<std::string>& sentences) {
  const auto explains = with(all, ExplanationVerdict::explains),
             implausible = with(all, ExplanationVerdict::implausible);
  const auto [best, less] = parted_by_likelihood(explains);
  if (best.size() == 1)
    sentences.push_back(
        fmt::format("One {} explains the difference: {}.", kind, change_text(check, *best[0])));
  else if (!best.empty()) {
    constexpr std::size_t most_with_values = 6;
    std::string values;
    for (std::size_t i = 0; i < best.size() && i < most_with_values; ++i)
      values += (i > 0 ? "; " : "") + change_text(check, *best[i]);
    if (best.size() > most_with_values)
      values += "; also " + names_of(check, Explanations(best.begin() + most_with_values, best.end()));
    sentences.push_back(
        fmt::format("Each of {} {} explains the difference equally well, and these modes cannot show which "
                    "is true: {}. {}",
                    best.size(), kinds, values, alike_note));
  } else {
    sentences.push_back(fmt::format("No plausible {} explains the difference.", kind));
  }
  if (!less.empty())
    sentences.push_back(fmt::format("Within the limit too, but less likely by a factor of 20 or more: {}.",
                                    names_of(check, less)));
  if (!implausible.empty()) {
    sentences.push_back(fmt::format("Implausible, though {} would reproduce the modes: {}.",
                                    implausible.size() == 1 ? "it" : "they", names_of(check, implausible)));
    if (explains.empty())
      sentences.push_back(fmt::format("Nearest of them: {}.", change_text(check, *implausible[0])));
  }
  if (const auto open = with(all, ExplanationVerdict::undetermined); !open.empty() && explains.empty())
    sentences.push_back(fmt::format("Not determined by these modes: {}. {} the plausible range.",
                                    names_of(check, open),
                                    open.size() == 1 ? "Its interval exceeds" : "Their intervals exceed"));
  return !explains.empty();
}

/// How near the best come where none explains: of all, and of those that are plausible. `all` begins with the
/// best.
void add_best(const ModelCheck& check, const std::vector<Explanation>& all, const char* kind,
              std::vector<std::string>& sentences) {
  const Explanation *best = nullptr, *plausible = nullptr;
  for (const Explanation& one : all) {
    if (one.verdict != ExplanationVerdict::leaves_much) continue;
    if (!best) best = &one;
    if (one.plausible && !plausible) plausible = &one;
  }
  const auto text = [&](const Explanation& e, const char* which) {
    return fmt::format("The best {} has a residual of {:.2g} % (root mean square): {}.",
                       fmt::format(fmt::runtime(which), kind),
                       100 * e.left.norm() / std::sqrt(static_cast<double>(e.left.size())),
                       change_text(check, e));
  };
  if (plausible) sentences.push_back(text(*plausible, "plausible {}"));
  if (best && best != plausible) sentences.push_back(text(*best, "{} of all, with implausible values,"));
}

/// What may be another one altogether and would then explain, "tip mass 0.27 instead of 0.71 kg"; whether
/// there is such a thing. A weight is exchanged more easily than a length.
bool add_exchanged(const ModelCheck& check, std::vector<std::string>& sentences) {
  if (!with(check.single, ExplanationVerdict::explains).empty()) return false;
  auto some = with(check.single, ExplanationVerdict::implausible);
  std::erase_if(some, [&](const Explanation* e) { return !candidate_in(check, *e).exchangeable; });
  std::stable_partition(some.begin(), some.end(),
                        [&](const Explanation* e) { return candidate_in(check, *e).value_unit == "kg"; });
  std::string text;
  for (const Explanation* one : some) {
    const Candidate& c = candidate_in(check, *one);
    text += (text.empty() ? "" : ", or ") + c.label;
    for (std::size_t s = 0; s < check.structures.size(); ++s)
      text += fmt::format("{} {:.3g} instead of {:.3g} {}", s == 0 ? "" : ",",
                          c.value(check.structures[s].structure, one->change[0]),
                          c.value(check.structures[s].structure, 0), c.value_unit);
  }
  if (text.empty()) return false;
  text[0] = static_cast<char>(std::toupper(text[0]));
  sentences.push_back(text +
                      " explains it. The change is implausibly large. Check for a wrong number in the file, "
                      "or a record of another structure.");
  return true;
}

/// The structure that stands against all others.
void add_outlier(const ModelCheck& check, std::vector<std::string>& sentences) {
  if (!check.outlier) return;
  sentences.push_back(fmt::format(
      "{} contradicts the others: without it {}.", check.structures[check.outlier->structure].name,
      check.outlier->others ? "one change explains them, " + change_text(check, *check.outlier->others)
                            : "they agree with their descriptions"));
}

/// Candidates whose effects are proportional, by the weighted cosine between them, each group at its largest.
std::vector<std::vector<std::size_t>> indistinguishable(const ModelCheck& check) {
  constexpr double proportional = 0.999;
  const auto count = static_cast<std::size_t>(check.alike.rows());
  const auto same = [&](std::size_t a, std::size_t b) {
    return std::abs(check.alike(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b))) > proportional;
  };
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t a = 0; a < count; ++a) {
    std::vector<std::size_t> group{a};
    for (std::size_t b = 0; b < count; ++b)
      if (b != a && std::all_of(group.begin(), group.end(), [&](std::size_t c) { return same(b, c); }))
        group.push_back(b);
    std::sort(group.begin(), group.end());
    if (group.size() > 1 && std::find(groups.begin(), groups.end(), group) == groups.end())
      groups.push_back(group);
  }
  return groups;
}

void add_twins(const ModelCheck& check, std::vector<std::string>& sentences) {
  if (check.numbers < 2) {
    sentences.emplace_back(
        "One frequency cannot distinguish candidates: any of them can be chosen to reproduce it.");
    return;
  }
  std::string groups;
  for (const std::vector<std::size_t>& group : indistinguishable(check)) {
    std::vector<std::string> names;
    for (const std::size_t c : group) names.push_back(check.candidates[c].label);
    groups += (groups.empty() ? "" : "; ") + joined(names);
  }
  if (!groups.empty())
    sentences.push_back(fmt::format("Indistinguishable by these modes, within each group: {}.", groups));
}

}  // namespace

std::vector<std::string> conclusions(const ModelCheck& check) {
  std::vector<std::string> sentences;
  const std::string what =
                        check.structures.size() > 1 ? "structures"
                        : check.structures[0].structure.is_beam() && !check.structures[0].structure.is_chain()
                            ? "beam"
                            : "structure",
                    size = fmt::format("chi^2 = {:.3g} for {} {} measured; the 95 % limit is {:.3g}",
                                       check.chi_square, check.numbers,
                                       check.numbers == 1 ? "number" : "numbers",
                                       chi_square_limit(static_cast<double>(check.numbers)));
  const bool several = check.structures.size() > 1;
  if (check.right) {
    sentences.push_back(
        fmt::format("The {} as described agree{} with what was identified: {}. No change is needed. The "
                    "table lists how far each quantity could differ without being detected.",
                    what, several ? "" : "s", size));
  } else {
    sentences.push_back(fmt::format("The {} as described do{} not agree with what was identified: {}.", what,
                                    several ? "" : "es", size));
    add_outlier(check, sentences);
    const bool exchanged = add_exchanged(check, sentences);
    if (!add_conclusions(check, check.single, "single change", "single changes", sentences)) {
      if (!exchanged) add_best(check, check.single, "single change", sentences);
      if (!check.pairs.empty() &&
          !add_conclusions(check, check.pairs, "pair of changes", "pairs of changes", sentences))
        add_best(check, check.pairs, "pair", sentences);
    }
  }
  add_twins(check, sentences);
  return sentences;
}

}  // namespace beamid::experiments
