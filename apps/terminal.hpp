// The terminal that text goes to, if it is one.
#pragma once

#include "apps/values.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::apps {

/// Where standard output is a terminal its width, COLUMNS of the environment before what it says itself, and
/// colours unless NO_COLOR is set or TERM is "dumb"; elsewhere 100 columns without colours.
experiments::Page terminal_page();

/// What is being done, on one line of standard error that is written over, where that is a terminal and
/// neither --quiet nor --no-progress is given; with --verbose a line each with the time since the start,
/// terminal or not; where a program receives what is found, that program is told. Safe to call from any
/// thread.
experiments::Progress show_progress(const Values& values);

/// Wipes that line.
void clear_progress();

}  // namespace beamid::apps
