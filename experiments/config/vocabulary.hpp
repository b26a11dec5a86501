// The keys an experiment file may hold.
#pragma once

#include <string>
#include <vector>

#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// The keys of one table. Tables nest by name: "record.time" is the table `time` in [record];
/// "record.channels" is an array of tables.
struct TableVocabulary {
  std::string table;              ///< empty for the root
  std::vector<std::string> keys;  ///< tables in it are keys too
  bool has_options = false;       ///< any other key is an option of the method chosen, which checks it
};

/// All of them; docs/configuration.md explains each one.
const std::vector<TableVocabulary>& vocabulary();

/// Looks through the whole file, before anything is read: a misspelt key is the better message than "length_m
/// is missing".
/// @throws InputError at the first unknown key; where there are several, what() has a line for each.
void refuse_unknown_keys(const TomlTable& root);

}  // namespace beamid::experiments
