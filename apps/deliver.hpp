// What every command does with what it found.
#pragma once

#include <functional>

#include "apps/command.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::apps {

/// Checks --out before any work is done, runs `find`, prints its results (text, or results.json with --json)
/// and writes them to --out.
void deliver(const options::variables_map& values, const std::function<experiments::Results()>& find);

/// Shows what is being done on one line of standard error, where that is a terminal.
experiments::Progress show_progress();

}  // namespace beamid::apps
