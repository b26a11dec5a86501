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
