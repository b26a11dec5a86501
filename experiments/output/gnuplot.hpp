// From a figure to gnuplot's language.
#pragma once

#include <string>

#include "experiments/output/figure.hpp"

namespace beamid::experiments {

/// A text as gnuplot shall read it: single-quoted (nothing is executed within) and with all that "enhanced
/// text" would interpret taken literally, but for "^{...}" and "_{...}".
std::string gnuplot_text(const std::string& label);

/// The script that draws NAME.svg and NAME.png from NAME.csv.
std::string gnuplot_script(const Figure& figure);

}  // namespace beamid::experiments
