// What an experiment file comes to, as results.json keeps it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"

namespace beamid::experiments {

/// The keys of the file, of what the command line set, and the defaults of every table that stands once, by
/// the names and in the order of docs/configuration.md: written as TOML they are the same experiment. A
/// default that is worked out from other values is left out, and so are those of tables in arrays.
/// @param also tables whose defaults hold though the file does not have them
nlohmann::ordered_json effective_keys(const TomlTable& root, const std::vector<std::string>& also = {});

/// Those of an experiment's file, with the methods, their options' defaults and the window that were chosen
/// since; nothing where it was read from none.
nlohmann::ordered_json effective_keys(const Experiment& experiment, const std::vector<std::string>& also = {});

/// The name of a method under a key of its table, and its options.
nlohmann::ordered_json keys_of(const Choice& choice, const char* key);

}  // namespace beamid::experiments
