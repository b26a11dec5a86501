// How several runs were made: commands, methods, versions.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/report/joined_report.hpp"

namespace beamid::experiments {

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
