#include "experiments/identify/parts/parts.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/config/channel_places.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

constexpr Eigen::Index most_whole_coordinates = 30;

// A name for every parameter, so that it means the same in every part.
void name_parameters(Experiment& experiment) {
  std::map<std::string, int> count, number;
  for (const ParameterChoice& choice : experiment.parameters)
    if (choice.name.empty()) ++count[choice.quantity];
  for (ParameterChoice& choice : experiment.parameters)
    if (choice.name.empty())
      choice.name = count[choice.quantity] > 1
                        ? fmt::format("{}_{}", choice.quantity, ++number[choice.quantity])
                        : choice.quantity;
}

Comparison identify_part(const Experiment& experiment, const ComparedRecord& record,
                         const PartOfStructure& part, Sections sections,
                         const std::filesystem::path& folder) {
  ComparedRecord own = record_of_part(experiment, record, part, sections);
  const Experiment asked = experiment_of_part(experiment, own, part);
  return compare(asked, std::move(own), folder, unwatched);
}

Comparison identify_whole(const Experiment& experiment, const ComparedRecord& record,
                          const std::filesystem::path& folder) {
  Experiment whole = experiment;
  whole.model = {"beam", model_registry().completed("beam", {{"sensor_bias", false}}), {}};
  whole.reduction = {"none", reduction::reduction_registry().completed("none", {}), {}};
  whole.reductions = {whole.reduction};
  whole.filters = {experiment.filter};
  whole.discretisations = {experiment.discretisation};
  return compare(whole, record, folder, unwatched);
}

std::vector<JoinedParameter> joined(const Experiment& experiment, const std::vector<IdentifiedPart>& parts) {
  std::vector<JoinedParameter> all;
  for (const ParameterChoice& choice : experiment.parameters) {
    JoinedParameter one{choice.name, {}, 0.0, 0.0, 0, 0.0, {}};
    std::vector<const ComparedParameter*> found;
    for (const IdentifiedPart& part : parts) {
      const ComparedRun& run = part.run(Sections::noisy);
      if (run.status != ComparedRun::Status::converged) continue;
      for (const ComparedParameter& parameter : run.parameters)
        if (parameter.estimate.name == choice.name) found.push_back(&parameter);
    }
    double weights = 0.0;
    for (const ComparedParameter* const parameter : found) {
      const double weight = 1.0 / (parameter->estimate.deviation * parameter->estimate.deviation);
      one.value += weight * parameter->estimate.value;
      weights += weight;
      one.unit = parameter->estimate.unit;
      one.truth = parameter->truth;
      ++one.parts;
      for (const ComparedParameter* const other : found)
        one.disagreement = std::max(one.disagreement,
                                    std::abs(other->estimate.value - parameter->estimate.value) /
                                        std::hypot(other->estimate.deviation, parameter->estimate.deviation));
    }
    if (one.parts == 0) continue;
    one.value /= weights;
    one.deviation = 1.0 / std::sqrt(weights);
    all.push_back(one);
  }
  return all;
}

}  // namespace

PartedIdentification identify_parts(const Experiment& given, const ComparedRecord& record,
                                    const std::filesystem::path& folder, bool whole,
                                    const Progress& progress) {
  Experiment experiment = given;
  name_parameters(experiment);
  ComparedRecord placed = record;
  placed.record = with_places(record.record, experiment);
  PartedIdentification result;
  for (const PartOfStructure& part : experiment.parts) result.parts.push_back({part, {}, {}});
  progress("parts");
  tbb::parallel_for(std::size_t{0}, 2 * result.parts.size(), [&](std::size_t i) {
    IdentifiedPart& one = result.parts[i / 2];
    if (i % 2 == 0)
      one.exact = identify_part(experiment, placed, one.part, Sections::exact, folder);
    else
      one.noisy = identify_part(experiment, placed, one.part, Sections::noisy, folder);
  });
  result.joined = joined(experiment, result.parts);
  const Eigen::Index coordinates = fem::assemble(experiment.structure, experiment.elements).size();
  if (whole && coordinates > most_whole_coordinates) {
    result.no_whole =
        fmt::format("The whole has {} coordinates: beyond {} it is not identified beside its parts.",
                    coordinates, most_whole_coordinates);
  } else if (whole) {
    progress("the whole");
    result.whole = identify_whole(experiment, placed, folder);
  }
  return result;
}

}  // namespace beamid::experiments
