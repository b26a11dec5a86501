#include "fem/structure.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "fem/frame_parameter.hpp"

namespace beamid::fem {
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

template <class AnyFrame>
void add_groups(const AnyFrame& frame, std::vector<std::string>& names) {
  for (const auto& member : frame.members)
    if (!member.group.empty() && std::find(names.begin(), names.end(), member.group) == names.end())
      names.push_back(member.group);
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
  if (frame()) return diagonal(places_of(*frame()));
  if (space_frame()) return diagonal(places_of(*space_frame()));
  return matrices() ? 1.0 : beam().length();
}

std::vector<std::string> place_names(const Structure& structure) {
  if (const Frame* const frame = structure.frame()) return frame_places(*frame);
  if (const SpaceFrame* const frame = structure.space_frame()) return frame_places(*frame);
  if (const MatrixSystem* const matrices = structure.matrices()) return matrices->labels;
  return {};
}

std::vector<std::string> factor_names(const Structure& structure) {
  std::vector<std::string> names;
  if (const Frame* const frame = structure.frame()) add_groups(*frame, names);
  if (const SpaceFrame* const frame = structure.space_frame()) add_groups(*frame, names);
  if (const MatrixSystem* const matrices = structure.matrices())
    for (const MatrixSystem::Parameter& parameter : matrices->parameters) names.push_back(parameter.name);
  return names;
}

Point natural_point(const Structure& structure) {
  if (structure.is_beam()) return natural_point(structure.beam());
  const std::vector<std::string> places = place_names(structure);
  if (places.empty()) throw std::invalid_argument("the supports hold every joint; expected some freedom");
  return {places.front(), 0.0, places.front()};
}

StructuralSystem assemble(const Structure& structure, int elements, const std::vector<Point>& points) {
  if (const Frame* const frame = structure.frame()) return assemble_at_places(*frame, elements, points);
  if (const SpaceFrame* const frame = structure.space_frame())
    return assemble_at_places(*frame, elements, points);
  if (const MatrixSystem* const matrices = structure.matrices()) return assemble(*matrices, points);
  return assemble(structure.beam(), elements, points);
}

StructuralSystem assemble(const Structure& structure, int elements) {
  if (structure.is_beam()) return assemble(structure.beam(), elements);
  return assemble(structure, elements, {natural_point(structure)});
}

double value_of(const Structure& structure, const BeamParameter& parameter) {
  if (const Frame* const frame = structure.frame()) return value_of(*frame, parameter);
  if (const SpaceFrame* const frame = structure.space_frame()) return value_of(*frame, parameter);
  if (const MatrixSystem* const matrices = structure.matrices()) return value_of(*matrices, parameter);
  return value_of(structure.beam(), parameter);
}

Structure with_value(const Structure& structure, const BeamParameter& parameter, double value) {
  if (const Frame* const frame = structure.frame()) return with_value(*frame, parameter, value);
  if (const SpaceFrame* const frame = structure.space_frame()) return with_value(*frame, parameter, value);
  if (const MatrixSystem* const matrices = structure.matrices())
    return with_value(*matrices, parameter, value);
  return with_value(structure.beam(), parameter, value);
}

ParametricSystem assemble_parametric(const Structure& structure, int elements,
                                     const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters) {
  if (const Frame* const frame = structure.frame())
    return assemble_parametric(*frame, elements, points, parameters);
  if (const SpaceFrame* const frame = structure.space_frame())
    return assemble_parametric(*frame, elements, points, parameters);
  if (const MatrixSystem* const matrices = structure.matrices())
    return assemble_parametric(*matrices, points, parameters);
  return assemble_parametric(structure.beam(), elements, points, parameters);
}

}  // namespace beamid::fem
