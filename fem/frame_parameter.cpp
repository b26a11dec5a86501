#include "fem/frame_parameter.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "fem/triplets.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index;

struct FramePlace {
  int joint = 0;
  char axis = 'x';
};

std::string joint_name(const Frame& frame, int joint) {
  const std::string& name = frame.joints[static_cast<std::size_t>(joint)].name;
  return name.empty() ? std::to_string(joint + 1) : name;
}

bool held(const Frame& frame, const FramePlace& place) {
  return std::any_of(frame.supports.begin(), frame.supports.end(), [&](const Frame::Support& support) {
    return support.joint == place.joint && (place.axis == 'x' ? support.x : support.y);
  });
}

FramePlace place_of(const Frame& frame, const std::string& name) {
  for (int joint = 0; joint < static_cast<int>(frame.joints.size()); ++joint)
    for (const char axis : {'x', 'y'})
      if (joint_name(frame, joint) + "." + axis == name) {
        if (held(frame, {joint, axis}))
          throw std::invalid_argument("place '" + name +
                                      "' is held by a support; expected one that can move");
        return {joint, axis};
      }
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
                                "'; expected group = \"" + parameter.name + "\" of [[frame.members]]");
}

}  // namespace

std::vector<std::string> frame_places(const Frame& frame) {
  std::vector<std::string> names;
  for (int joint = 0; joint < static_cast<int>(frame.joints.size()); ++joint)
    for (const char axis : {'x', 'y'})
      if (!held(frame, {joint, axis})) names.push_back(joint_name(frame, joint) + "." + axis);
  return names;
}

StructuralSystem assemble_at_places(const Frame& frame, int elements_per_member,
                                    const std::vector<Point>& points) {
  validate(frame);
  std::vector<FramePlace> places;
  std::vector<FramePoint> joints;
  std::map<int, std::string> named;
  for (const Point& point : points) {
    places.push_back(place_of(frame, point.place));
    const int joint = places.back().joint;
    if (named.try_emplace(joint, std::to_string(joint)).second)
      joints.push_back({std::to_string(joint), joint});
  }
  StructuralSystem system = assemble(frame, elements_per_member, joints);
  const auto count = static_cast<Index>(points.size());
  const auto number = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
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
    system.base_shares[i] = place.axis == frame.base_axis ? 1.0 : 0.0;
  }
  columns.emplace_back(number(system.input_names, std::string("base_acceleration_") + frame.base_axis), count,
                       1.0);
  input_names.emplace_back("base_acceleration");
  system.inputs = system.inputs * sparse(system.inputs.cols(), count + 1, columns);
  system.outputs = sparse(count, system.outputs.rows(), rows) * system.outputs;
  system.input_names = input_names;
  system.output_names = output_names;
  return system;
}

double value_of(const Frame& frame, const BeamParameter& parameter) {
  double value = 0.0;
  for_group(frame, parameter, [&](const Frame::Member& member) { value = member.stiffness_factor; });
  return value;
}

Frame with_value(const Frame& frame, const BeamParameter& parameter, double value) {
  if (!(value > 0.0 && std::isfinite(value))) {
    std::ostringstream message;
    message << "factor '" << parameter.name << "' is " << value << "; expected a positive number";
    throw std::invalid_argument(message.str());
  }
  const double found = value_of(frame, parameter);
  Frame changed = frame;
  for_group(changed, parameter, [&](Frame::Member& member) { member.stiffness_factor *= value / found; });
  return changed;
}

ParametricSystem assemble_parametric(const Frame& frame, int elements_per_member,
                                     const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters) {
  ParametricSystem result;
  result.system = assemble_at_places(frame, elements_per_member, points);
  result.strain = result.system.stiffness.strain;
  result.values.resize(static_cast<Index>(parameters.size()));
  const Index n = result.system.size();
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const double value = value_of(frame, parameters[j]);
    result.values[static_cast<Index>(j)] = value;
    const StructuralSystem twice =
        assemble_at_places(with_value(frame, parameters[j], 2.0 * value), elements_per_member, points);
    SparseMatrix slope = twice.stiffness.rigidity - result.system.stiffness.rigidity;
    slope.prune([](Index, Index, double entry) { return entry != 0.0; });
    result.derivatives.push_back({SparseMatrix(n, n), slope / value,
                                  SparseMatrix(n, result.system.inputs.cols()), SparseMatrix(n, n)});
  }
  return result;
}

}  // namespace beamid::fem
