// The name that was probably meant.
#pragma once

#include <string>
#include <vector>

namespace beamid::apps {

/// "; did you mean 'modes'?", or nothing where no name is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

/// Libraries list what they know: "unknown filter 'ufk'; known: ekf, enkf, ..., ukf". Here a name that is
/// near takes the place of a list longer than a few: "unknown filter 'ufk'; did you mean 'ukf'?". Line by
/// line.
std::string with_suggestions(const std::string& message);

}  // namespace beamid::apps
