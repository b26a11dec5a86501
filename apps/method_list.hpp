// Methods of one kind, told to a reader.
#pragma once

#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "experiments/results/text.hpp"
#include "filters/options.hpp"

namespace beamid::apps {

/// What every registry knows of a method.
struct Method {
  std::string name;
  std::string summary;  ///< one line
  std::string source;   ///< keys in docs/references.md, or words
  std::vector<filters::OptionSpec> options;
  std::set<std::string> contracts;
};

/// All methods of a kind: what each is, and its options with their defaults.
struct MethodList {
  std::string kind;  ///< in messages: "filter"
  std::vector<Method> methods;

  /// @throws std::invalid_argument "unknown filter 'ufk'; known: ekf, ukf".
  const Method& find(const std::string& name) const;
};

/// A line or two for each method.
void print(std::ostream& stream, const MethodList& list, const experiments::Page& page);

/// All about one: what it is, its sources in full words, its options with defaults, units and meaning, and
/// the promises that the conformance tests hold it to.
void print(std::ostream& stream, const Method& method, const experiments::Page& page);

}  // namespace beamid::apps
