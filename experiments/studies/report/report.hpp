// Results of several commands on one page, and their numbers side by side.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/results/table.hpp"

namespace beamid::experiments {

/// A results.json and what to call it.
struct NamedResults {
  std::string name;
  nlohmann::ordered_json json;
  nlohmann::ordered_json made_with =
      nlohmann::ordered_json::object();  ///< compiler and libraries -> versions; empty: not known
};

/// The estimates, with standard deviations, that at least two of the results have under one name
/// (joined_report.cpp): each with half its 95 % interval, and of two results the difference, also in
/// combined standard deviations, (b - a) / sqrt(sa^2 + sb^2).
Table parameters_side_by_side(const std::vector<NamedResults>& results);

/// The other numbers, a row each; those that are the same everywhere are left out. Of two results the
/// difference in per cent.
/// @param all also those within lists; else the numbers of a result as a whole, and errors of its runs
Table numbers_side_by_side(const std::vector<NamedResults>& results, bool all);

/// Writes the page of all folders, whole or not at all: what differs between their configurations, their
/// parameters and numbers side by side, methods and versions (steps.hpp), then the page of each.
/// @param all as numbers_side_by_side()
/// @throws InputError naming a folder that holds no results of beamid, or none that has a page.
void write_joined_report(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& file,
                         bool all = false);

// How several runs were made: commands, methods, versions.

/// A row for each setting of the configurations, as "filter.method", whose values are not the same in all
/// runs;
/// "-" where a run has none. Long texts are cut.
Table configuration_differences(const std::vector<NamedResults>& results);

/// Command and methods of every run, then what it was made with: beamid, compiler and libraries, as its
/// timing.json tells; a row each.
Table run_versions(const std::vector<NamedResults>& results);

/// The part of a page that shows the commands that repeat the runs, and run_versions().
/// @param commands as the pages of the runs show them; empty: not known
std::string methods_html(const std::vector<NamedResults>& results, const std::vector<std::string>& commands);

}  // namespace beamid::experiments
