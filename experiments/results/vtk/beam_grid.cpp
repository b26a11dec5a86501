#include "experiments/results/vtk/beam_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Core>

namespace beamid::experiments {
namespace {

// The outlines of sections along a structure's elements.

/// Corners of the section at one end of an element, from the node there, counterclockwise seen against the
/// element's direction from first to second node; those of a sharp end coincide. An end of a space frame's
/// member lies beyond its offset.
/// @param picture one with a beam or a space frame
std::vector<Eigen::Vector3d> section_corners(const Picture& picture, const fem::Mesh::Element& element,
                                             bool at_second);

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

using fem::Mesh;

constexpr std::size_t most_grid_elements = 20'000;
constexpr double steel_density = 7850.0;  // [kg/m3]

// Elements from `first` to `last`, drawn as one.
struct Stretch {
  std::size_t first, last;
};

bool continues(const Mesh::Element& before, const Mesh::Element& next) {
  return before.second == next.first && before.segment == next.segment && before.remaining == next.remaining;
}

std::vector<Stretch> stretches(const Picture& picture) {
  const std::vector<Mesh::Element>& elements = picture.system.mesh.elements;
  const std::size_t most = elements.size() / (most_grid_elements + 1) + 1;
  std::vector<Stretch> result;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const bool joins = e > 0 && continues(elements[e - 1], elements[e]) && e - result.back().first < most;
    if (joins)
      result.back().last = e;
    else
      result.push_back({e, e});
  }
  return result;
}

class Drawing {
 public:
  explicit Drawing(const Picture& picture) : picture_(picture), mesh_(picture.system.mesh) {
    grid_.nodes = nodal_places(picture.system);
  }

  BeamGrid finish() {
    if (picture_.surface)
      draw_surface();
    else
      draw_lines();
    if (picture_.beam != nullptr)
      for (const fem::Body& body : picture_.beam->bodies)
        draw_body(mesh_.node_at(body.position), {body.eccentricity, 0.0, 0.0}, body.mass);
    if (picture_.space_frame != nullptr)
      for (const fem::SpaceFrame::Body& body : picture_.space_frame->bodies)
        draw_body(body.joint, body.offset, body.mass);
    return std::move(grid_);
  }

 private:
  const Picture& picture_;
  const Mesh& mesh_;
  BeamGrid grid_;

  int add_point(int node, const Vector3d& offset) {
    grid_.points.push_back({node, offset});
    return static_cast<int>(grid_.points.size()) - 1;
  }

  void add_cell(BeamGrid::Cell cell, const std::vector<int>& corners) {
    cell.first_corner = grid_.corners.size();
    cell.size = static_cast<int>(corners.size());
    grid_.corners.insert(grid_.corners.end(), corners.begin(), corners.end());
    grid_.cells.push_back(cell);
  }

  BeamGrid::Cell properties(const Stretch& stretch) const {
    const Mesh::Element& first = mesh_.elements[stretch.first];
    BeamGrid::Cell cell;
    cell.section = first.segment + 1;
    cell.element = static_cast<int>(stretch.first) + 1;
    cell.damage = 1.0 - first.remaining;
    if (picture_.beam != nullptr) {
      const double middle = 0.5 * (first.from + mesh_.elements[stretch.last].to);
      cell.bending_stiffness =
          first.remaining * picture_.beam->segments[first.segment].section.bending_stiffness(middle);
    } else if (picture_.space_frame != nullptr) {
      const fem::SpaceFrame::Member& member = picture_.space_frame->members[first.segment];
      cell.bending_stiffness = member.stiffness_factor * member.section.bending_stiffness_y;
    }
    return cell;
  }

  void draw_lines() {
    for (Eigen::Index node = 0; node < grid_.nodes.cols(); ++node)
      add_point(static_cast<int>(node), Vector3d::Zero());
    for (const Stretch& stretch : stretches(picture_))
      add_cell(properties(stretch),
               {mesh_.elements[stretch.first].first, mesh_.elements[stretch.last].second});
  }

  std::vector<int> ring(const Mesh::Element& element, bool at_second) {
    std::vector<int> points;
    for (const Vector3d& corner : section_corners(picture_, element, at_second))
      points.push_back(add_point(at_second ? element.second : element.first, corner));
    return points;
  }

  // Corners run counterclockwise seen from outside, so that normals point outwards.
  void draw_surface() {
    std::vector<int> previous;
    const std::vector<Stretch> all = stretches(picture_);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Mesh::Element& first = mesh_.elements[all[i].first];
      const Mesh::Element& last = mesh_.elements[all[i].last];
      const BeamGrid::Cell cell = properties(all[i]);
      if (previous.empty()) {
        previous = ring(first, false);
        add_cell(cell, {previous.rbegin(), previous.rend()});
      }
      const std::vector<int> next = ring(last, true);
      for (std::size_t k = 0; k < next.size(); ++k) {
        const std::size_t beside = (k + 1) % next.size();
        add_cell(cell, {previous[k], previous[beside], next[beside], next[k]});
      }
      previous = next;
      const bool ends = i + 1 == all.size() || mesh_.elements[all[i + 1].first].segment != first.segment;
      if (!ends) continue;
      add_cell(cell, next);
      previous.clear();
    }
  }

  void draw_body(int node, const Vector3d& centre, double mass) {
    BeamGrid::Cell cell;
    cell.mass = mass;
    if (!picture_.surface) {
      add_cell(cell, {add_point(node, centre)});
      return;
    }
    if (mass == 0.0) return;
    const double half = 0.5 * std::cbrt(mass / steel_density);
    int corner[2][2][2];
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 2; ++k)
          corner[i][j][k] = add_point(node, centre + half * Vector3d(2 * i - 1, 2 * j - 1, 2 * k - 1));
    for (int i = 0; i < 2;
         ++i) {  // the sides whose normals are x, y and z; below zero they run the other way
      std::vector<int> faces[3] = {{corner[i][0][0], corner[i][1][0], corner[i][1][1], corner[i][0][1]},
                                   {corner[0][i][0], corner[0][i][1], corner[1][i][1], corner[1][i][0]},
                                   {corner[0][0][i], corner[1][0][i], corner[1][1][i], corner[0][1][i]}};
      for (std::vector<int>& face : faces) {
        if (i == 0) std::reverse(face.begin(), face.end());
        add_cell(cell, face);
      }
    }
  }
};

}  // namespace

BeamGrid beam_grid(const Picture& picture) {
  return Drawing(picture).finish();
}

Eigen::Matrix3Xd translation_of_points(const BeamGrid& grid, const NodalMotion& motion) {
  Eigen::Matrix3Xd moved(3, static_cast<Eigen::Index>(grid.points.size()));
  for (Eigen::Index i = 0; i < moved.cols(); ++i) {
    const BeamGrid::Point& point = grid.points[i];
    const Vector3d turn = motion.rotation.col(point.node), &arm = point.offset;
    const Vector3d swing(turn.y() * arm.z() - turn.z() * arm.y(), turn.z() * arm.x() - turn.x() * arm.z(),
                         turn.x() * arm.y() - turn.y() * arm.x());
    moved.col(i) = motion.translation.col(point.node) + swing;
  }
  return moved;
}

Eigen::Matrix3Xd rotation_of_points(const BeamGrid& grid, const NodalMotion& motion) {
  Eigen::Matrix3Xd turned(3, static_cast<Eigen::Index>(grid.points.size()));
  for (Eigen::Index i = 0; i < turned.cols(); ++i) turned.col(i) = motion.rotation.col(grid.points[i].node);
  return turned;
}

}  // namespace beamid::experiments
