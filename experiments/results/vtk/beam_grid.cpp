#include "experiments/results/vtk/beam_grid.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/results/vtk/swept_sections.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Vector3d;
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
