#include "experiments/results/vtk/swept_sections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamid::experiments {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr int ellipse_sides = 24;
constexpr double end_of_member = 1e-9;

std::vector<Vector2d> rectangle(double width, double height) {
  const double y = 0.5 * width, z = 0.5 * height;
  return {{y, z}, {-y, z}, {-y, -z}, {y, -z}};
}

std::vector<Vector2d> beam_outline(const fem::Beam& beam, const fem::Section& section, double s) {
  const fem::Outline& outline = section.outline;
  const double length = beam.length();
  if (outline.shape == fem::Outline::Shape::none) return rectangle(length / 20, length / 100);
  const double width = outline.width(s), height = outline.height(s);
  if (outline.shape != fem::Outline::Shape::ellipse) return rectangle(width, height);
  std::vector<Vector2d> corners;
  for (int side = 0; side < ellipse_sides; ++side) {
    const double angle = 2.0 * std::numbers::pi * side / ellipse_sides;
    corners.emplace_back(0.5 * width * std::cos(angle), 0.5 * height * std::sin(angle));
  }
  return corners;
}

// I / A = side^2 / 12 of a rectangle.
std::vector<Vector2d> member_outline(const fem::SpaceSection& section) {
  if (!section.outline.empty()) return section.outline;
  const auto side = [&](double bending) { return std::sqrt(12.0 * bending / section.axial_stiffness); };
  return rectangle(side(section.bending_stiffness_z), side(section.bending_stiffness_y));
}

Vector3d offset_of(const fem::SpaceFrame::Member& member, double s) {
  if (s < end_of_member) return member.at_first.offset;
  return s > 1.0 - end_of_member ? member.at_second.offset : Vector3d(Vector3d::Zero());
}

}  // namespace

std::vector<Vector3d> section_corners(const Picture& picture, const fem::Mesh::Element& element,
                                      bool at_second) {
  const auto segment = static_cast<std::size_t>(element.segment);
  const double s = at_second ? element.to : element.from;
  std::vector<Vector3d> corners;
  if (picture.beam != nullptr) {
    for (const Vector2d& corner : beam_outline(*picture.beam, picture.beam->segments[segment].section, s))
      corners.emplace_back(0.0, corner[0], corner[1]);
    return corners;
  }
  const fem::SpaceFrame::Member& member = picture.space_frame->members[segment];
  const Eigen::Matrix3d axes = picture.space_frame->axes(segment);
  const Vector3d offset = offset_of(member, s);
  for (const Vector2d& corner : member_outline(member.section))
    corners.emplace_back(offset + axes.rightCols<2>() * corner);
  if (element.from > element.to) std::reverse(corners.begin(), corners.end());
  return corners;
}

}  // namespace beamid::experiments
