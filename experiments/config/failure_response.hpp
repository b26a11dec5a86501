// What a run does when its filter fails, by name.
#pragma once

#include <string>

#include "filters/running_filter.hpp"

namespace beamid::experiments {

/// @throws std::invalid_argument "on_failure is 'inflat'; expected stop, inflate, report"
filters::OnFailure failure_response(const std::string& name);
const char* to_string(filters::OnFailure response);

}  // namespace beamid::experiments
