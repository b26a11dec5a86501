// What speaks against a result: every kind that exists, and one that was found.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace beamid::experiments {

/// A kind of objection. docs/objections.md and `beamid list objections` are made of these.
struct ObjectionKind {
  std::string name;       ///< "not_settled"
  std::string of;         ///< results that are tested for it: "records", "free decays", "any model", "modes"
  std::string statistic;  ///< what decides, with its limit
  std::string meaning;    ///< what is wrong with a result that has it
};

/// All kinds, sorted by what they are of, then by name.
const std::vector<ObjectionKind>& objection_kinds();

/// One that was found in a result.
struct Objection {
  /// @param statistic and limit of the kind's statistic, where one number decided
  /// @throws std::logic_error when there is no such kind
  Objection(std::string name, std::string text, double statistic = std::numeric_limits<double>::quiet_NaN(),
            double limit = std::numeric_limits<double>::quiet_NaN());

  std::string name;  ///< of its kind
  std::string text;  ///< sentences: the fact with its number, what follows from it, what to do
  double statistic, limit;
};

/// Their sentences.
std::vector<std::string> texts(const std::vector<Objection>& objections);

}  // namespace beamid::experiments
