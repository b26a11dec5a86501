#include "experiments/identify/parts/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/models/motion/supported_motion.hpp"
#include "experiments/models/structure_points.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

enum class Where { inside, section, outside };

// By position, between the sections.
Where where_along(const fem::Structure& structure, const PartOfStructure& part, double position) {
  const double slack = 1e-9 * structure.extent();
  for (const auto& section : {part.from, part.to})
    if (section && std::abs(position - *section) < slack) return Where::section;
  const bool above = !part.from || position > *part.from, below = !part.to || position < *part.to;
  return above && below ? Where::inside : Where::outside;
}

// By name: connected to the part's own place without passing its supports.
std::vector<Where> where_by_name(const Experiment& experiment, const Record& record,
                                 const PartOfStructure& part) {
  StructurePoints points(experiment.structure);
  const Index own = points.add({}, part.inside);
  std::vector<Index> supports, places;
  for (const std::string& place : part.supports) supports.push_back(points.add({}, place));
  for (const Channel& channel : record.channels)
    places.push_back(channel.quantity == Quantity::base_acceleration ? -1 : points.add({}, channel.place));
  const fem::StructuralSystem system = fem::assemble(experiment.structure, experiment.elements, points.all());
  const std::vector<bool> inside = connected_inside(system, {own}, supports);
  std::vector<Where> where;
  for (const Index place : places) {
    const bool section = std::find(supports.begin(), supports.end(), place) != supports.end();
    where.push_back(section ? Where::section
                    : place >= 0 && inside[static_cast<std::size_t>(coordinate_of(system, place))]
                        ? Where::inside
                        : Where::outside);
  }
  return where;
}

std::vector<Where> where_are(const Experiment& experiment, const Record& record,
                             const PartOfStructure& part) {
  if (!experiment.structure.has_positions()) return where_by_name(experiment, record, part);
  std::vector<Where> where;
  for (const Channel& channel : record.channels)
    where.push_back(channel.position ? where_along(experiment.structure, part, *channel.position)
                                     : Where::outside);
  return where;
}

// Whether the base holds a part itself, and not through its sections.
bool stands_on_base(const PartOfStructure& part) {
  return part.supports.empty() && !part.from;
}

bool is_accelerometer(const Channel& channel) {
  return channel.quantity == Quantity::acceleration || channel.quantity == Quantity::angular_acceleration;
}

void refuse_of_span(const PartOfStructure& part, const Channel& channel, const char* expected) {
  throw InputError(part.place, fmt::format("substructure '{}': '{}' is of {}; expected {}", part.name,
                                           channel.name, to_string(channel.quantity), expected));
}

// Of a span, rotations at its sections that no channel holds.
void add_missing_rotations(const PartOfStructure& part, double length, Index inside, Record& record) {
  std::vector<double> missing;
  for (const auto& section : {part.from, part.to}) {
    const auto turns = [&](const Channel& one) {
      return one.quantity == Quantity::support_angular_acceleration &&
             std::abs(*one.position - *section) < 1e-9 * length;
    };
    if (section && std::none_of(record.channels.begin(), record.channels.end(), turns))
      missing.push_back(*section);
  }
  const auto count = static_cast<Index>(missing.size());
  if (count > 0 && inside <= count)
    throw InputError(
        part.place,
        fmt::format("substructure '{}': {} of the rotations at its sections {} not measured; expected "
                    "angular_acceleration there, or more than {} channels inside in their place",
                    part.name, count, count == 1 ? "is" : "are", count));
  for (const double section : missing) {
    record.channels.push_back({Quantity::support_angular_acceleration,
                               fmt::format("rotation at {:g} m", section),
                               section,
                               0.0,
                               {},
                               std::numeric_limits<double>::infinity()});
    record.samples.conservativeResize(record.samples.rows() + 1, Eigen::NoChange);
    record.samples.bottomRows(1).setZero();
  }
}

void require_sections(const PartOfStructure& part, Index found) {
  const Index wanted = part.supports.empty() ? (part.from ? 1 : 0) + (part.to ? 1 : 0)
                                             : static_cast<Index>(part.supports.size());
  if (found < wanted)
    throw InputError(part.place,
                     fmt::format("substructure '{}': {} of its {} sections {} an accelerometer; expected one "
                                 "channel of acceleration at each",
                                 part.name, found, wanted, found == 1 ? "has" : "have"));
}

// As many elements as a span's motion needs: 24 in it, unless the structure would have more than 400.
int elements_of_span(const Experiment& experiment, const PartOfStructure& part) {
  constexpr double in_span = 24.0, most = 400.0;
  const double length = experiment.structure.extent(),
               span = part.to.value_or(length) - part.from.value_or(0.0);
  return std::max(experiment.elements, static_cast<int>(std::min(most, std::ceil(in_span * length / span))));
}

}  // namespace

bool has_spans(const fem::Structure& structure) {
  return structure.is_beam() && !structure.is_chain();
}

ComparedRecord record_of_part(const Experiment& experiment, const ComparedRecord& record,
                              const PartOfStructure& part, Sections sections) {
  const std::vector<Where> where = where_are(experiment, record.record, part);
  ComparedRecord result{record.name, {}, {}, record.truth, record.notes};
  result.record.time = record.record.time;
  result.record.time_resolution = record.record.time_resolution;
  result.record.remarks = record.record.remarks;
  result.record.objections = record.record.objections;
  result.record.input_path = record.record.input_path;
  const bool spans = has_spans(experiment.structure);
  std::vector<Index> kept;
  Index found = 0, inside = 0;
  for (std::size_t i = 0; i < where.size(); ++i) {
    Channel channel = record.record.channels[i];
    if (channel.quantity == Quantity::base_acceleration) {
      if (spans) refuse_of_span(part, channel, "a structure whose base is at rest where its parts are spans");
      if (!stands_on_base(part)) continue;
      if (sections == Sections::exact) channel.noise = 0.0;
    } else if (where[i] == Where::section) {
      if (!is_accelerometer(channel)) continue;
      channel.noise = stated_noise(experiment, channel);
      if (sections == Sections::noisy && !(channel.noise > 0.0))
        throw InputError(
            part.place,
            fmt::format("substructure '{}': the noise of '{}', which is measured at its section, is "
                        "not stated; expected noise in [[record.channels]] or [noise]",
                        part.name, channel.name));
      if (sections == Sections::exact) channel.noise = 0.0;
      found += is_angular(channel.quantity) ? 0 : 1;
      channel.quantity = is_angular(channel.quantity) ? Quantity::support_angular_acceleration
                                                      : Quantity::support_acceleration;
    } else if (where[i] == Where::outside) {
      continue;
    } else if (is_input(channel.quantity)) {
      if (sections == Sections::exact) channel.noise = 0.0;
    } else {
      if (spans && !is_accelerometer(channel))
        refuse_of_span(part, channel, "accelerations and forces inside a span");
      ++inside;
    }
    kept.push_back(static_cast<Index>(i));
    result.record.channels.push_back(channel);
  }
  require_sections(part, found);
  if (inside == 0)
    throw InputError(
        part.place,
        fmt::format("substructure '{}': no sensor sits inside it; expected at least one", part.name));
  result.record.samples = record.record.samples(kept, Eigen::all);
  if (record.sensor_noise.size() > 0) result.sensor_noise = record.sensor_noise(kept);
  if (spans) add_missing_rotations(part, experiment.structure.extent(), inside, result.record);
  return result;
}

Experiment experiment_of_part(const Experiment& experiment, const ComparedRecord& part_record,
                              const PartOfStructure& part) {
  Experiment own = experiment;
  own.parts.clear();
  own.model = {"beam", model_registry().completed("beam", {{"sensor_bias", false}}), {}};
  own.reduction = {"none", reduction::reduction_registry().completed("none", {}), {}};
  own.reductions = {own.reduction};
  own.filters = {experiment.filter};
  own.discretisations = {experiment.discretisation};
  if (has_spans(experiment.structure)) own.elements = elements_of_span(experiment, part);
  for (const Quantity input : {Quantity::force, Quantity::base_acceleration, Quantity::support_acceleration})
    if (const auto given = own.noise.find(input); given != own.noise.end()) {
      const bool counts =
          std::any_of(part_record.record.channels.begin(), part_record.record.channels.end(),
                      [&](const Channel& one) { return is_input(one.quantity) && one.noise > 0; });
      if (!counts) own.noise.erase(given);
    }
  const ModelSetting setting = model_setting(own, part_record.record, own.reduction);
  own.parameters.clear();
  for (const ParameterChoice& choice : experiment.parameters) {
    if (choice.quantity == "damping_ratio")
      refuse(
          choice,
          "a damping_ratio is of the whole structure's modes, which a substructure does not have; expected "
          "stiffness_damping or dashpots");
    if (const auto quantity = beam_quantity(choice.quantity)) {
      const std::vector<ParameterDefault> defaults = beam_defaults(experiment.structure, {choice});
      const fem::ParametricSystem equations = beam_equations(setting, {unknown_of(choice, defaults.front())});
      std::vector<Index> supports;
      for (const Index support : setting.supports) supports.push_back(support);
      const SupportedEquations cut = supported_equations(equations, setting.forces, supports, -1);
      const auto& slope = cut.derivatives.front();
      if (slope.mass.isZero(0.0) && slope.damping.isZero(0.0) && slope.stiffness.isZero(0.0)) continue;
    }
    own.parameters.push_back(choice);
  }
  if (own.parameters.empty())
    throw InputError(part.place,
                     fmt::format("substructure '{}' has none of the [[parameters]]; expected one that "
                                 "belongs to it",
                                 part.name));
  return own;
}

}  // namespace beamid::experiments
