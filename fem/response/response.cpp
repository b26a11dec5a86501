#include "fem/response/response.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "fem/response/method.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::VectorXd;

struct Entry {
  ResponseMethodDescription description;
  ResponseFunction function;
};

std::map<std::string, Entry>& registry() {
  static std::map<std::string, Entry> entries;
  return entries;
}

const Entry& find(const std::string& name) {
  if (const auto it = registry().find(name); it != registry().end()) return it->second;
  std::string known;
  for (const auto& [other, entry] : registry()) known += (known.empty() ? "" : ", ") + other;
  throw std::invalid_argument("unknown response method '" + name + "'; known: " + known);
}

ResponseOptions completed(const ResponseMethodDescription& method, const ResponseOptions& given) {
  ResponseOptions options;
  std::string known;
  for (const ResponseOption& option : method.options) {
    options[option.name] = option.fallback;
    known += (known.empty() ? "" : ", ") + option.name;
  }
  for (const auto& [option, value] : given) {
    if (!options.contains(option))
      throw std::invalid_argument("unknown option '" + option + "' of response method '" + method.name + "'" +
                                  (known.empty() ? "; it has none" : "; known: " + known));
    options[option] = value;
  }
  return options;
}

void check(const TimeGrid& grid) {
  std::ostringstream message;
  if (!(grid.interval > 0.0 && std::isfinite(grid.interval)))
    message << "response: interval is " << grid.interval << " s; expected a finite time above 0";
  else if (grid.samples < 1)
    message << "response: " << grid.samples << " samples; expected at least 1";
  for (std::size_t i = 0; i < grid.frames.size() && message.str().empty(); ++i) {
    const Index frame = grid.frames[i];
    if (frame < 0 || frame >= grid.samples)
      message << "response: frame " << frame << "; expected 0 to " << grid.samples - 1;
    else if (i > 0 && frame <= grid.frames[i - 1])
      message << "response: frame " << frame << " after " << grid.frames[i - 1]
              << "; expected ascending ones";
  }
  if (!message.str().empty()) throw std::invalid_argument(message.str());
}

VectorXd initial(const VectorXd& given, Index size, const char* what) {
  if (given.size() == 0) return VectorXd::Zero(size);
  if (given.size() != size)
    throw std::invalid_argument("response: initial " + std::string(what) + " has " +
                                std::to_string(given.size()) + " entries; expected " + std::to_string(size));
  if (!given.allFinite())
    throw std::invalid_argument("response: initial " + std::string(what) + " is not finite");
  return given;
}

void check_inputs(const Eigen::MatrixXd& inputs, Index rows, Index samples) {
  if (inputs.size() == 0) return;
  if (inputs.rows() != rows || inputs.cols() != samples)
    throw std::invalid_argument("response: inputs are " + std::to_string(inputs.rows()) + " x " +
                                std::to_string(inputs.cols()) + "; expected " + std::to_string(rows) + " x " +
                                std::to_string(samples) + " (inputs x samples)");
  if (!inputs.allFinite()) throw std::invalid_argument("response: inputs are not finite");
}

}  // namespace

bool register_response_method(ResponseMethodDescription description, ResponseFunction function) {
  const std::string name = description.name;
  if (!registry().emplace(name, Entry{std::move(description), std::move(function)}).second)
    throw std::logic_error("response method '" + name + "' is registered twice");
  return true;
}

std::vector<ResponseMethodDescription> response_methods() {
  std::vector<ResponseMethodDescription> methods;
  for (const auto& [name, entry] : registry()) methods.push_back(entry.description);
  return methods;
}

Response respond(const StructuralSystem& system, const DampingLaw& damping, const Loading& loading,
                 const TimeGrid& grid, const ResponseMethod& method) {
  const Entry& entry = find(method.name);
  const ResponseOptions options = completed(entry.description, method.options);
  check(grid);
  check_inputs(loading.inputs, system.inputs.cols(), grid.samples);
  const ResponseProblem problem{system,
                                damping,
                                grid,
                                initial(loading.initial_displacement, system.size(), "displacement"),
                                initial(loading.initial_velocity, system.size(), "velocity"),
                                loading.inputs};
  return entry.function(problem, options);
}

}  // namespace beamid::fem
