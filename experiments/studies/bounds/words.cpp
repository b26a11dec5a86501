#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/studies/bounds/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;
using BoundVerdict = ParameterBound::Verdict;

// "a", "a and b", "a, b and c"
std::string list_of(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return text;
}

std::vector<std::string> named(const Identifiability& found, BoundVerdict verdict) {
  std::vector<std::string> names;
  for (const ParameterBound& p : found.parameters)
    if (p.verdict == verdict && !p.nuisance) names.push_back(p.name);
  return names;
}

std::string identifiability_percent(const ParameterBound& p, double value) {
  return fmt::format("{:.2g} %{}", value, p.of_value ? "" : " of its prior standard deviation");
}

std::string determined_text(const Identifiability& found) {
  constexpr double roughly = 20.0;  // %: a 95 % interval that is as wide as four fifths of the value
  std::vector<std::string> determined, rough, poor;
  for (const ParameterBound& p : found.parameters) {
    if (p.nuisance) continue;
    if (p.verdict == BoundVerdict::determined)
      (p.bound_percent() < roughly ? determined : rough)
          .push_back(fmt::format("{} to {}", p.name, identifiability_percent(p, p.bound_percent())));
    if (p.verdict == BoundVerdict::poor)
      poor.push_back(fmt::format("{} (bound {})", p.name, identifiability_percent(p, p.bound_percent())));
  }
  std::string text = !determined.empty() ? "Determined: " + list_of(determined) + "."
                     : rough.empty()     ? "No parameter is determined by itself."
                                         : "No parameter is determined well.";
  if (!rough.empty()) text += " Only roughly: " + list_of(rough) + ".";
  if (!poor.empty()) text += " In principle, but not in practice: " + list_of(poor) + ".";
  return text;
}

std::string silent_text(const Identifiability& found) {
  std::string text;
  if (const auto names = named(found, BoundVerdict::nothing); !names.empty())
    text += "Not at all: no sensor shows anything of " + list_of(names) + ".";
  const Eigen::MatrixXd silent = silent_combinations(found.report);
  for (Index k = 0; k < silent.cols(); ++k) {
    std::vector<std::string> changes, names;
    for (std::size_t j = 0; j < found.parameters.size(); ++j) {
      const double change = silent(static_cast<Index>(j), k);
      if (change == 0.0) continue;
      changes.push_back(fmt::format("{} by {:+.3g} %", found.parameters[j].name, change));
      names.push_back(found.parameters[j].name);
    }
    if (names.size() < 2) continue;
    text += fmt::format("{}Only in combination: {}. To change {} does not alter the record.",
                        text.empty() ? "" : " ", list_of(names), list_of(changes));
  }
  return text;
}

// Two parameters that are hard to tell apart.
std::string correlation_text(const Identifiability& found) {
  constexpr double strong = 0.95;
  const auto q = static_cast<Index>(found.parameters.size());
  Index one = -1, other = -1;
  double largest = strong;
  for (Index i = 0; i < q; ++i)
    for (Index j = 0; j < i; ++j)
      if (std::abs(found.report.correlations(i, j)) > largest && found.report.determined(i) &&
          found.report.determined(j)) {
        largest = std::abs(found.report.correlations(i, j));
        one = j;
        other = i;
      }
  if (one < 0) return {};
  const ParameterBound &a = found.parameters[static_cast<std::size_t>(one)],
                       &b = found.parameters[static_cast<std::size_t>(other)];
  return fmt::format(
      "{} and {} are hard to distinguish (correlation {:+.4f}). Were all others known, they would be known "
      "to {:.2g} % and {:.2g} % instead of {:.2g} % and {:.2g} %.",
      a.name, b.name, found.report.correlations(one, other), a.conditional_percent(), b.conditional_percent(),
      a.bound_percent(), b.bound_percent());
}

/// How the bounds change from one entry of a sweep to another.
struct SettingChange {
  std::vector<std::string> parts;       ///< "tip_mass from 0.1 to 0.05 %"
  bool all = true;                      ///< every bound changes by more than a little
  double least = INFINITY, most = 0.0;  ///< factor
};

SettingChange change(const Identifiability& found, const BoundSweep& sweep, Index from, Index to) {
  constexpr double little = 0.05;
  SettingChange result;
  for (std::size_t j = 0; j < found.parameters.size(); ++j) {
    const double before = sweep.percent(from, static_cast<Index>(j)),
                 after = sweep.percent(to, static_cast<Index>(j));
    if (!std::isfinite(before) || !std::isfinite(after) || found.parameters[j].nuisance) continue;
    const double factor = after / before;
    result.least = std::min(result.least, factor);
    result.most = std::max(result.most, factor);
    if (std::abs(factor - 1.0) > little)
      result.parts.push_back(
          fmt::format("{} from {:.2g} to {:.2g} %", found.parameters[j].name, before, after));
    else
      result.all = false;
  }
  return result;
}

std::string length_text(const Identifiability& found) {
  std::string text;
  const Index last = found.lengths.at.size() - 1;
  if (last > found.described_length) {
    const SettingChange longer = change(found, found.lengths, found.described_length, last);
    const std::string would =
        fmt::format("A record of {:.4g} s instead of {:.4g} s would", found.lengths.at[last], found.duration);
    if (!longer.parts.empty())
      text = fmt::format("{} bring {}{}.", would, list_of(longer.parts),
                         longer.all ? "" : ", and almost no improvement of the rest");
    else if (longer.most > 0.0)
      text = would + " bring almost no improvement.";
  }
  if (found.slowest_decay > 0.0)
    text += fmt::format(
        "{}Mode 1 decays with a time constant of {:.3g} s. Three time constants contain 91 % of the "
        "information about damping. This record has {:.2g}.",
        text.empty() ? "" : " ", found.slowest_decay, found.duration / found.slowest_decay);
  return text;
}

std::string rate_text(const Identifiability& found) {
  if (found.rates.at.size() < 2) return {};
  const SettingChange slower = change(found, found.rates, 0, 1);
  if (slower.parts.empty()) return {};
  constexpr double alike = 1.03;
  std::string text = fmt::format("Sampled at {:g} instead of {:g} Hz with the same noise in every sample, ",
                                 found.rates.at[1], found.rates.at[0]);
  if (slower.most < alike * slower.least)
    text += fmt::format("all bounds are {:.3g} times as large.", slower.most);
  else
    text += "bounds change: " + list_of(slower.parts) + ".";
  if (found.rates.beside.minCoeff() < static_cast<double>(found.frequencies_hz.size()))
    text +=
        " Modes above half the rate appear at other frequencies. The bounds count their information, as the "
        "model contains where they appear. An anti-aliasing filter would take them away.";
  return text;
}

}  // namespace

std::vector<std::string> words(const Identifiability& found) {
  std::vector<std::string> paragraphs;
  for (const std::string& text : {determined_text(found), silent_text(found), correlation_text(found),
                                  length_text(found), rate_text(found)})
    if (!text.empty()) paragraphs.push_back(text);
  return paragraphs;
}

}  // namespace beamid::experiments
