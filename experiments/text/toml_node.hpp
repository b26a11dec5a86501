// What a TomlTable stands on. Only its own sources include this file and, with it, toml++.
#pragma once

#include <toml++/toml.h>

#include <map>
#include <memory>
#include <string>

#include "experiments/text/toml_table.hpp"

static_assert(!TOML_HEADER_ONLY, "the header-only toml++ 3.3 aborts on the input '[/'; link its library");

namespace beamid::experiments {

struct TomlTable::Node {
  std::shared_ptr<const toml::table> root;  ///< owns every table below it
  const toml::table* table;
  std::string file;
  std::string name;
  /// Where keys come from that the file does not hold, by their path: "beam.length_m" from "--length".
  std::shared_ptr<const std::map<std::string, std::string>> origins;

  std::shared_ptr<const Node> below(const toml::table* inner, std::string inner_name) const {
    return std::make_shared<const Node>(Node{root, inner, file, std::move(inner_name), origins});
  }
  Place at(const toml::source_region& region) const { return {file, region.begin.line, region.begin.column}; }
};

/// A value as messages name it: -1, the text "abc", an array of 3.
std::string found(const toml::node& node);

}  // namespace beamid::experiments
