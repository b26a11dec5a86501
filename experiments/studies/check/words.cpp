#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "experiments/identify/model_check/explanation.hpp"
#include "experiments/signal/chi_square_limit.hpp"
#include "experiments/studies/check/report.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using ExplanationVerdict = Explanation::Verdict;

std::string readable(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// "tip mass +0.05 kg (0.03 to 0.07)".
std::string change_text(const ModelCheck& check, const Explanation& e) {
  std::string text;
  for (std::size_t i = 0; i < e.candidates.size(); ++i) {
    const Candidate& c = check.candidates[e.candidates[i]];
    const double shown = c.unit == "%" ? 100 : 1;
    text += fmt::format("{}{} {:+.3g} {} (95 %: {:+.3g} to {:+.3g}{})", i > 0 ? " with " : "",
                        readable(c.name), shown * e.change[i], c.unit, shown * e.lower_95(i),
                        shown * e.upper_95(i), e.at_limit[i] ? ", at the limit of what is possible" : "");
  }
  return text;
}

std::vector<const Explanation*> with(const std::vector<Explanation>& all, ExplanationVerdict verdict) {
  std::vector<const Explanation*> found;
  for (const Explanation& one : all)
    if (one.verdict == verdict) found.push_back(&one);
  return found;
}

std::string names_of(const ModelCheck& check, const std::vector<const Explanation*>& some) {
  std::vector<std::string> names;
  for (const Explanation* one : some) {
    std::string name = readable(check.candidates[one->candidates[0]].name);
    if (one->candidates.size() > 1) name += " with " + readable(check.candidates[one->candidates[1]].name);
    names.push_back(std::move(name));
  }
  return joined(names);
}

/// What explains among one kind, single or pairs; whether anything plausible does.
bool add_conclusions(const ModelCheck& check, const std::vector<Explanation>& all, const char* kind,
                     std::vector<std::string>& sentences) {
  const auto explains = with(all, ExplanationVerdict::explains),
             implausible = with(all, ExplanationVerdict::implausible);
  if (explains.size() == 1)
    sentences.push_back(
        fmt::format("One {} explains the difference: {}.", kind, change_text(check, *explains[0])));
  else if (!explains.empty())
    sentences.push_back(
        fmt::format("Each {0} of these explains the difference, and these data cannot tell which is true: "
                    "{1}. Nearest: {2}. "
                    "Another mode, or the same beam with another tip mass, would tell more.",
                    kind, names_of(check, explains), change_text(check, *explains[0])));
  else
    sentences.push_back(fmt::format("No plausible {} explains the difference.", kind));
  if (!implausible.empty()) {
    sentences.push_back(fmt::format("Implausible, though {} would reproduce the frequencies: {}.",
                                    implausible.size() == 1 ? "it" : "they", names_of(check, implausible)));
    if (explains.empty())
      sentences.push_back(fmt::format("Nearest of them: {}.", change_text(check, *implausible[0])));
  }
  if (const auto open = with(all, ExplanationVerdict::undetermined); !open.empty() && explains.empty())
    sentences.push_back(fmt::format(
        "Within what these data can tell, {} would do too, with intervals wider than what is plausible: {}.",
        open.size() == 1 ? "this one" : "these", names_of(check, open)));
  return !explains.empty();
}

/// How near the best come where none explains: of all, and of those that are plausible.
void tell_best(const ModelCheck& check, const std::vector<Explanation>& all, const char* kind,
               std::vector<std::string>& sentences) {
  const Explanation *best = nullptr, *plausible = nullptr;
  for (const Explanation& one : all) {
    if (one.verdict != ExplanationVerdict::leaves_much) continue;
    if (!best || one.chi_square < best->chi_square) best = &one;
    if (one.plausible && (!plausible || one.chi_square < plausible->chi_square)) plausible = &one;
  }
  const auto text = [&](const Explanation& e, const char* which) {
    return fmt::format(
        "The best {} leaves {:.2g} % (root mean square): {}.", fmt::format(fmt::runtime(which), kind),
        100 * e.left.norm() / std::sqrt(static_cast<double>(e.left.size())), change_text(check, e));
  };
  if (plausible) sentences.push_back(text(*plausible, "plausible {}"));
  if (best && best != plausible) sentences.push_back(text(*best, "{} of all, with implausible values,"));
}

/// What may be another one altogether and would then explain, "tip mass 0.27 instead of 0.71 kg"; whether
/// there is such a thing. A weight is exchanged more easily than a length.
bool tell_exchanged(const ModelCheck& check, std::vector<std::string>& sentences) {
  if (!with(check.single, ExplanationVerdict::explains).empty()) return false;
  auto some = with(check.single, ExplanationVerdict::implausible);
  const auto candidate = [&](const Explanation* e) -> const Candidate& {
    return check.candidates[e->candidates[0]];
  };
  std::erase_if(some, [&](const Explanation* e) { return !candidate(e).exchangeable; });
  std::stable_partition(some.begin(), some.end(),
                        [&](const Explanation* e) { return candidate(e).name == "tip_mass"; });
  std::string text;
  for (const Explanation* one : some) {
    const Candidate& c = candidate(one);
    text += (text.empty() ? "" : ", or ") + readable(c.name);
    for (std::size_t s = 0; s < check.structures.size(); ++s)
      text += fmt::format("{} {:.3g} instead of {:.3g} {}", s == 0 ? "" : ",",
                          c.value(check.structures[s].beam, one->change[0]),
                          c.value(check.structures[s].beam, 0), c.value_unit);
  }
  if (text.empty()) return false;
  text[0] = static_cast<char>(std::toupper(text[0]));
  sentences.push_back(
      text +
      " explains it: more than careful work gets wrong, as much as a wrong number in the file "
      "does, or the record of another beam.");
  return true;
}

/// The structure that stands against all others.
void tell_outlier(const ModelCheck& check, std::vector<std::string>& sentences) {
  if (!check.outlier) return;
  sentences.push_back(fmt::format(
      "{} contradicts the others: without it {}.", check.structures[check.outlier->structure].name,
      check.outlier->others ? "one change explains them, " + change_text(check, *check.outlier->others)
                            : "they agree with their descriptions"));
}

/// Candidates whose effects are proportional, by the weighted cosine between them.
void tell_twins(const ModelCheck& check, std::vector<std::string>& sentences) {
  constexpr double alike = 0.999;
  if (check.effect.rows() < 2) {
    sentences.emplace_back(
        "One frequency cannot tell candidates apart: any of them can be chosen to reproduce it.");
    return;
  }
  const Eigen::MatrixXd weighted = variances(check).cwiseSqrt().cwiseInverse().asDiagonal() * check.effect;
  std::vector<std::string> twins;
  for (Eigen::Index a = 0; a < weighted.cols(); ++a)
    for (Eigen::Index b = a + 1; b < weighted.cols(); ++b)
      if (std::abs(weighted.col(a).normalized().dot(weighted.col(b).normalized())) > alike)
        twins.push_back(readable(check.candidates[a].name) + " and " + readable(check.candidates[b].name));
  if (!twins.empty())
    sentences.push_back(fmt::format(
        "Not separable by these frequencies, since both move them in one proportion: {}.", joined(twins)));
}

}  // namespace

std::vector<std::string> conclusions(const ModelCheck& check) {
  const auto count = static_cast<Eigen::Index>(check.modes.size());
  std::vector<std::string> sentences;
  const std::string size =
      fmt::format("chi^2 = {:.3g} for {} {}; the 95 % limit is {:.3g}", check.chi_square, count,
                  count == 1 ? "frequency" : "frequencies", chi_square_limit(static_cast<double>(count)));
  if (check.right) {
    sentences.push_back(
        fmt::format("The beam as described agrees with what was identified: {}. No change is "
                    "called for; the table shows what each could be unseen.",
                    size));
  } else {
    sentences.push_back(
        fmt::format("The beam as described does not agree with what was identified: {}.", size));
    tell_outlier(check, sentences);
    const bool exchanged = tell_exchanged(check, sentences);
    if (!add_conclusions(check, check.single, "single change", sentences)) {
      if (!exchanged) tell_best(check, check.single, "single change", sentences);
      if (!check.pairs.empty() && !add_conclusions(check, check.pairs, "pair of changes", sentences))
        tell_best(check, check.pairs, "pair", sentences);
    }
  }
  tell_twins(check, sentences);
  return sentences;
}

}  // namespace beamid::experiments
