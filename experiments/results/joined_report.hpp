// Results of several commands on one page, and their numbers side by side.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/results/table.hpp"

namespace beamid::experiments {

/// A results.json and what to call it.
struct NamedResults {
  std::string name;
  nlohmann::ordered_json json;
  nlohmann::ordered_json made_with =
      nlohmann::ordered_json::object();  ///< compiler and libraries -> versions; empty: not known
};

/// The numbers that at least two of the results have under the same key, a row each; those that are the same
/// everywhere are left out, of long lists all but the first entries. With two results their difference in
/// per cent.
Table side_by_side(const std::vector<NamedResults>& results);

/// Writes the page of all folders, whole or not at all: their numbers side by side, methods and versions
/// (report_methods.hpp), then the page of each.
/// @throws InputError naming a folder that holds no results of beamid, or none that has a page.
void write_joined_report(const std::vector<std::filesystem::path>& folders,
                         const std::filesystem::path& file);

}  // namespace beamid::experiments
