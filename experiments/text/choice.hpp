// The choice of a registered method, as a user's file states it.
#pragma once

#include <string>

#include "experiments/text/input_error.hpp"
#include "filters/options.hpp"

namespace beamid::experiments {

/// A registered method and its options, chosen by name.
struct Choice {
  std::string name;
  filters::Options options;
  Place place = {};  ///< where it was chosen, for messages; empty when it was not
  std::string shape_file =
      {};  ///< of a reduction that takes a given shape; relative to the TOML file's folder; empty: none
};

}  // namespace beamid::experiments
