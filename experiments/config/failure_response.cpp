#include "experiments/config/failure_response.hpp"

#include <stdexcept>

namespace beamid::experiments {

using filters::OnFailure;

const char* to_string(OnFailure response) {
  switch (response) {
    case OnFailure::inflate:
      return "inflate";
    case OnFailure::report:
      return "report";
    case OnFailure::stop:
      break;
  }
  return "stop";
}

OnFailure failure_response(const std::string& name) {
  for (const OnFailure response : {OnFailure::stop, OnFailure::inflate, OnFailure::report})
    if (name == to_string(response)) return response;
  throw std::invalid_argument("on_failure is '" + name + "'; expected stop, inflate, report");
}

}  // namespace beamid::experiments
