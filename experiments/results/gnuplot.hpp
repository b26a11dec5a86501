// From a figure to gnuplot's language.
#pragma once

#include <string>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// A text as gnuplot shall read it: cleaned (clean_text.hpp), in double quotes, with octal codes for what
/// these would execute or expand ("`", "@"), and with all that "enhanced text" would interpret taken
/// literally, but for "^{...}" and "_{...}".
std::string gnuplot_text(const std::string& label);

/// The script that draws NAME.svg and NAME.png from NAME.csv.
std::string gnuplot_script(const Figure& figure);

}  // namespace beamid::experiments
