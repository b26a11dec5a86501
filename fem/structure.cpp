#include "fem/structure.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <Eigen/Geometry>

#include "fem/parametric_system.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index;

struct FramePlace {
  int joint = 0;
  char axis = 'x';
};

// What plane and space frames differ in.
std::string axes_of(const Frame&) {
  return "xy";
}
std::string axes_of(const SpaceFrame&) {
  return "xyz";
}

std::string table_of(const Frame&) {
  return "frame";
}
std::string table_of(const SpaceFrame&) {
  return "space_frame";
}

bool holds(const Frame::Support& support, char axis) {
  return axis == 'x' ? support.x : support.y;
}
bool holds(const SpaceFrame::Support& support, char axis) {
  return axis == 'x' ? support.x : axis == 'y' ? support.y : support.z;
}

// Of the base's motion, along each axis.
Eigen::Vector3d base_share(const Frame& frame) {
  return frame.base_axis == 'x' ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
}
Eigen::Vector3d base_share(const SpaceFrame& frame) {
  return frame.base_direction.normalized();
}

StructuralSystem assembled(const Frame& frame, int elements, const std::vector<int>& joints) {
  std::vector<FramePoint> points;
  for (const int joint : joints) points.push_back({std::to_string(joint), joint});
  return assemble(frame, elements, points);
}
StructuralSystem assembled(const SpaceFrame& frame, int elements, const std::vector<int>& joints) {
  std::vector<SpaceFramePoint> points;
  for (const int joint : joints) points.push_back({std::to_string(joint), joint});
  return assemble(frame, elements, points);
}

template <class AnyFrame>
std::string joint_name(const AnyFrame& frame, int joint) {
  const std::string& name = frame.joints[static_cast<std::size_t>(joint)].name;
  return name.empty() ? std::to_string(joint + 1) : name;
}

// Places by name, in their order, those that supports hold told apart.
template <class AnyFrame, class Function>
void for_places(const AnyFrame& frame, const Function& f) {
  const std::string axes = axes_of(frame);
  std::vector<std::vector<bool>> held(frame.joints.size(), std::vector<bool>(axes.size(), false));
  for (const auto& support : frame.supports)
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (holds(support, axes[i])) held[static_cast<std::size_t>(support.joint)][i] = true;
  for (int joint = 0; joint < static_cast<int>(frame.joints.size()); ++joint)
    for (std::size_t i = 0; i < axes.size(); ++i)
      f(joint_name(frame, joint) + "." + axes[i], FramePlace{joint, axes[i]},
        held[static_cast<std::size_t>(joint)][i]);
}

template <class AnyFrame>
FramePlace place_of(const AnyFrame& frame, const std::string& name) {
  std::optional<FramePlace> found;
  for_places(frame, [&](const std::string& own, const FramePlace& place, bool held) {
    if (found || own != name) return;
    if (held)
      throw std::invalid_argument("place '" + name + "' is held by a support; expected one that can move");
    found = place;
  });
  if (found) return *found;
  throw std::invalid_argument("the frame has no place '" + name +
                              "'; expected a joint and a direction, such as '" + joint_name(frame, 0) +
                              ".x'");
}

// Members of the group that a factor names.
template <class AnyFrame, class Function>
void for_group(AnyFrame& frame, const BeamParameter& parameter, const Function& f) {
  if (parameter.quantity != BeamParameter::Quantity::factor)
    throw std::invalid_argument("a frame has no such quantity; expected factor, with the name of a group");
  bool found = false;
  for (auto& member : frame.members)
    if (!member.group.empty() && member.group == parameter.name) f(member), found = true;
  if (!found)
    throw std::invalid_argument("no member of the frame is of the group '" + parameter.name +
                                "'; expected group = \"" + parameter.name + "\" of [[" + table_of(frame) +
                                ".members]]");
}

template <class AnyFrame>
std::vector<std::string> places_in(const AnyFrame& frame) {
  std::vector<std::string> names;
  for_places(frame, [&](const std::string& name, const FramePlace&, bool held) {
    if (!held) names.push_back(name);
  });
  return names;
}

template <class AnyFrame>
StructuralSystem assemble_places(const AnyFrame& frame, int elements_per_member,
                                 const std::vector<Point>& points) {
  validate(frame);
  std::vector<FramePlace> places;
  std::vector<int> joints;
  for (const Point& point : points) {
    places.push_back(place_of(frame, point.place));
    if (std::find(joints.begin(), joints.end(), places.back().joint) == joints.end())
      joints.push_back(places.back().joint);
  }
  StructuralSystem system = assembled(frame, elements_per_member, joints);
  const auto count = static_cast<Index>(points.size());
  const auto number = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  const std::string axes = axes_of(frame);
  const Eigen::Vector3d share = base_share(frame);
  Triplets columns, rows;
  std::vector<std::string> input_names, output_names;
  system.base_shares.setZero(count);
  for (Index i = 0; i < count; ++i) {
    const FramePlace& place = places[static_cast<std::size_t>(i)];
    const std::string own = std::to_string(place.joint), end = std::string("_") + place.axis;
    columns.emplace_back(number(system.input_names, own + "_force" + end), i, 1.0);
    rows.emplace_back(i, number(system.output_names, own + "_displacement" + end), 1.0);
    input_names.push_back(points[static_cast<std::size_t>(i)].name + "_force");
    output_names.push_back(points[static_cast<std::size_t>(i)].name + "_displacement");
    system.base_shares[i] = share[static_cast<Index>(axes.find(place.axis))];
  }
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (share[static_cast<Index>(i)] != 0.0)
      columns.emplace_back(number(system.input_names, std::string("base_acceleration_") + axes[i]), count,
                           share[static_cast<Index>(i)]);
  input_names.emplace_back("base_acceleration");
  system.inputs = system.inputs * sparse(system.inputs.cols(), count + 1, columns);
  system.outputs = sparse(count, system.outputs.rows(), rows) * system.outputs;
  system.input_names = input_names;
  system.output_names = output_names;
  return system;
}

template <class AnyFrame>
double factor_of(const AnyFrame& frame, const BeamParameter& parameter) {
  double value = 0.0;
  for_group(frame, parameter, [&](const auto& member) { value = member.stiffness_factor; });
  return value;
}

template <class AnyFrame>
AnyFrame with_factor(const AnyFrame& frame, const BeamParameter& parameter, double value) {
  if (!(value > 0.0 && std::isfinite(value))) {
    std::ostringstream message;
    message << "factor '" << parameter.name << "' is " << value << "; expected a positive number";
    throw std::invalid_argument(message.str());
  }
  const double found = factor_of(frame, parameter);
  AnyFrame changed = frame;
  for_group(changed, parameter, [&](auto& member) { member.stiffness_factor *= value / found; });
  return changed;
}

template <class AnyFrame>
ParametricSystem assemble_factors(const AnyFrame& frame, int elements_per_member,
                                  const std::vector<Point>& points,
                                  const std::vector<BeamParameter>& parameters) {
  ParametricSystem result;
  result.system = assemble_places(frame, elements_per_member, points);
  result.strain = result.system.stiffness.strain;
  result.values.resize(static_cast<Index>(parameters.size()));
  const Index n = result.system.size();
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const double value = factor_of(frame, parameters[j]);
    result.values[static_cast<Index>(j)] = value;
    const StructuralSystem twice =
        assemble_places(with_factor(frame, parameters[j], 2.0 * value), elements_per_member, points);
    SparseMatrix slope = twice.stiffness.rigidity - result.system.stiffness.rigidity;
    slope.prune([](Index, Index, double entry) { return entry != 0.0; });
    result.derivatives.push_back({SparseMatrix(n, n), slope / value,
                                  SparseMatrix(n, result.system.inputs.cols()), SparseMatrix(n, n)});
  }
  return result;
}

}  // namespace

std::vector<std::string> frame_places(const Frame& frame) {
  return places_in(frame);
}

StructuralSystem assemble_at_places(const Frame& frame, int elements_per_member,
                                    const std::vector<Point>& points) {
  return assemble_places(frame, elements_per_member, points);
}

double value_of(const Frame& frame, const BeamParameter& parameter) {
  return factor_of(frame, parameter);
}

Frame with_value(const Frame& frame, const BeamParameter& parameter, double value) {
  return with_factor(frame, parameter, value);
}

ParametricSystem assemble_parametric(const Frame& frame, int elements_per_member,
                                     const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters) {
  return assemble_factors(frame, elements_per_member, points, parameters);
}

std::vector<std::string> frame_places(const SpaceFrame& frame) {
  return places_in(frame);
}

StructuralSystem assemble_at_places(const SpaceFrame& frame, int elements_per_member,
                                    const std::vector<Point>& points) {
  return assemble_places(frame, elements_per_member, points);
}

double value_of(const SpaceFrame& frame, const BeamParameter& parameter) {
  return factor_of(frame, parameter);
}

SpaceFrame with_value(const SpaceFrame& frame, const BeamParameter& parameter, double value) {
  return with_factor(frame, parameter, value);
}

ParametricSystem assemble_parametric(const SpaceFrame& frame, int elements_per_member,
                                     const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters) {
  return assemble_factors(frame, elements_per_member, points, parameters);
}

namespace {

double diagonal(const std::vector<Eigen::Vector3d>& places) {
  Eigen::AlignedBox3d around;
  for (const Eigen::Vector3d& place : places) around.extend(place);
  return around.diagonal().norm();
}

std::vector<Eigen::Vector3d> places_of(const Frame& frame) {
  std::vector<Eigen::Vector3d> places;
  for (const Frame::Joint& joint : frame.joints) places.emplace_back(joint.x, joint.y, 0.0);
  return places;
}
std::vector<Eigen::Vector3d> places_of(const SpaceFrame& frame) {
  std::vector<Eigen::Vector3d> places;
  for (const SpaceFrame::Joint& joint : frame.joints) places.push_back(joint.place);
  return places;
}

/// f of the structure's kind: the one place that asks which it is.
template <class Function>
auto with_kind(const Structure& structure, const Function& f) {
  if (const Frame* const frame = structure.frame()) return f(*frame);
  if (const SpaceFrame* const frame = structure.space_frame()) return f(*frame);
  if (const MatrixSystem* const matrices = structure.matrices()) return f(*matrices);
  return f(structure.beam());
}

/// One function for each kind; the last of them generic, for both frames.
template <class... Functions>
struct OfKind : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
OfKind(Functions...) -> OfKind<Functions...>;

template <class AnyFrame>
std::vector<std::string> member_groups(const AnyFrame& frame) {
  std::vector<std::string> names;
  for (const auto& member : frame.members)
    if (!member.group.empty() && std::find(names.begin(), names.end(), member.group) == names.end())
      names.push_back(member.group);
  return names;
}

std::vector<std::string> parameter_names(const MatrixSystem& matrices) {
  std::vector<std::string> names;
  for (const MatrixSystem::Parameter& parameter : matrices.parameters) names.push_back(parameter.name);
  return names;
}

}  // namespace

const Beam& Structure::beam() const {
  if (const Beam* const beam = std::get_if<Beam>(&kind_)) return *beam;
  throw std::invalid_argument(std::string("this needs a beam; found a ") +
                              (space_frame() ? "space frame" : kind()) +
                              ". Expected [beam] in the experiment file");
}

const char* Structure::kind() const {
  return frame()         ? "frame"
         : space_frame() ? "space_frame"
         : matrices()    ? "system"
         : is_chain()    ? "chain"
                         : "beam";
}

double Structure::extent() const {
  return with_kind(
      *this, OfKind{[](const Beam& beam) { return beam.length(); }, [](const MatrixSystem&) { return 1.0; },
                    [](const auto& frame) { return diagonal(places_of(frame)); }});
}

std::vector<std::string> place_names(const Structure& structure) {
  return with_kind(structure, OfKind{[](const Beam&) { return std::vector<std::string>(); },
                                     [](const MatrixSystem& matrices) { return matrices.labels; },
                                     [](const auto& frame) { return frame_places(frame); }});
}

std::vector<std::string> factor_names(const Structure& structure) {
  return with_kind(structure, OfKind{[](const Beam&) { return std::vector<std::string>(); },
                                     [](const MatrixSystem& matrices) { return parameter_names(matrices); },
                                     [](const auto& frame) { return member_groups(frame); }});
}

Point natural_point(const Structure& structure) {
  if (structure.is_beam()) return natural_point(structure.beam());
  const std::vector<std::string> places = place_names(structure);
  if (places.empty()) throw std::invalid_argument("the supports hold every joint; expected some freedom");
  return {places.front(), 0.0, places.front()};
}

StructuralSystem assemble(const Structure& structure, int elements, const std::vector<Point>& points) {
  return with_kind(structure,
                   OfKind{[&](const Beam& beam) { return assemble(beam, elements, points); },
                          [&](const MatrixSystem& matrices) { return assemble(matrices, points); },
                          [&](const auto& frame) { return assemble_at_places(frame, elements, points); }});
}

StructuralSystem assemble(const Structure& structure, int elements) {
  if (structure.is_beam()) return assemble(structure.beam(), elements);
  return assemble(structure, elements, {natural_point(structure)});
}

double value_of(const Structure& structure, const BeamParameter& parameter) {
  return with_kind(structure, [&](const auto& kind) { return value_of(kind, parameter); });
}

Structure with_value(const Structure& structure, const BeamParameter& parameter, double value) {
  return with_kind(structure,
                   [&](const auto& kind) -> Structure { return with_value(kind, parameter, value); });
}

ParametricSystem assemble_parametric(const Structure& structure, int elements,
                                     const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters) {
  return with_kind(
      structure,
      OfKind{[&](const MatrixSystem& matrices) { return assemble_parametric(matrices, points, parameters); },
             [&](const auto& kind) { return assemble_parametric(kind, elements, points, parameters); }});
}

}  // namespace beamid::fem
