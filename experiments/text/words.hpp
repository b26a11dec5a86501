// Words of the command line and of short texts, taken apart.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "filters/options.hpp"

namespace beamid::experiments {

/// The parts between separators, empty ones included; at least one.
std::vector<std::string> split(const std::string& text, char separator);

/// A word that is a finite number as a whole; nothing else, not even a blank.
std::optional<double> number(const std::string& word);

/// A value as the user would write it; a number as the shortest that reads back the same, those of a list
/// parted by "/".
std::string word_of(const filters::OptionValue& value);

}  // namespace beamid::experiments
