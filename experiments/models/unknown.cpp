#include "experiments/models/unknown.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {

const char* to_string(Form form) {
  switch (form) {
    case Form::linear:
      return "linear";
    case Form::logarithmic:
      return "logarithmic";
    case Form::bounded:
      return "bounded";
  }
  return "";
}

double Unknown::to_state(double physical) const {
  const bool allowed = form == Form::linear        ? std::isfinite(physical)
                       : form == Form::logarithmic ? physical > 0.0 && std::isfinite(physical)
                                                   : physical > lower && physical < upper;
  if (!allowed)
    throw std::invalid_argument(
        form == Form::bounded ? fmt::format("{} is {:g}; expected a number between its bounds {:g} and {:g}",
                                            name, physical, lower, upper)
                              : fmt::format("{} is {:g}; expected a {} number", name, physical,
                                            form == Form::linear ? "finite" : "positive"));
  if (form == Form::linear) return physical;
  if (form == Form::logarithmic) return std::log(physical);
  return std::log((physical - lower) / (upper - physical));
}

double Unknown::to_physical(double state) const {
  if (form == Form::linear) return state;
  if (form == Form::logarithmic) return std::exp(state);
  return lower + (upper - lower) / (1.0 + std::exp(-state));
}

double Unknown::slope(double state) const {
  if (form == Form::linear) return 1.0;
  if (form == Form::logarithmic) return std::exp(state);
  const double share = 1.0 / (1.0 + std::exp(-state));
  return (upper - lower) * share * (1.0 - share);
}

}  // namespace beamid::experiments
