// What every command does with what it found.
#pragma once

#include <functional>

#include "apps/command.hpp"
#include "apps/terminal.hpp"
#include "apps/values.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::apps {

/// Checks --out before any work is done, runs `find`, prints its results (text, or results.json with --json)
/// and writes them to --out. Where a program receives them, nothing is printed.
/// @returns the exit code: 3 where a message of the report is a failure, so that there is nothing to rely on,
/// which is no error of the command's; else 0
int deliver(const Values& values, const std::function<experiments::Results()>& find);

}  // namespace beamid::apps
