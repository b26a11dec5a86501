#include "experiments/results/mode_figure.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "experiments/results/vtk/nodal_motion.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

struct ModeLine {
  std::vector<double> x, y;

  void add(const Vector2d& point) {
    x.push_back(point[0]);
    y.push_back(point[1]);
  }
  void gap() { add(Vector2d::Constant(std::numeric_limits<double>::quiet_NaN())); }

  Curve curve(Colour colour) const {
    const auto vector = [](const std::vector<double>& values) {
      return Eigen::VectorXd(
          Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
    };
    return {"", vector(x), vector(y), CurveStyle::line, {}, {}, colour};
  }
};

// What a picture shows of space: of a plane structure x and z, of a spatial one the view from its front, left
// and above.
Eigen::Matrix<double, 2, 3> view_of(const fem::StructuralSystem& system) {
  Eigen::Matrix<double, 2, 3> view;
  if (!system.mesh.spatial)
    view << 1, 0, 0, 0, 0, 1;
  else  // azimuth -60 degrees, elevation 25
    view << 0.8660254, 0.5, 0, -0.2113091, 0.3659981, 0.9063078;
  return view;
}

// Where the axis of an element goes, from 0 at its first node to 1 at its second: linear along it, Hermite's
// cubic across it.
class ElementPath {
 public:
  ElementPath(const fem::Mesh::Element& element, const Eigen::Matrix3Xd& places, const NodalMotion& motion) {
    const int nodes[2] = {element.first, element.second};
    const Vector3d along = (places.col(nodes[1]) - places.col(nodes[0])).normalized();
    for (const int end : {0, 1}) {
      place_[end] = places.col(nodes[end]);
      moved_[end] = motion.translation.col(nodes[end]);
      slope_[end] = element.length * motion.rotation.col(nodes[end]).cross(along);
    }
    const Vector3d drift = moved_[1] - moved_[0], chord = drift - along * along.dot(drift);
    for (Vector3d& slope : slope_) slope -= chord;
  }

  Vector3d place(double s) const { return (1 - s) * place_[0] + s * place_[1]; }
  Vector3d displacement(double s) const {
    const double t = 1 - s;
    return t * moved_[0] + s * moved_[1] + s * t * t * slope_[0] - s * s * t * slope_[1];
  }

 private:
  Vector3d place_[2], moved_[2], slope_[2];
};

struct Shape {
  ModeLine undeformed, deformed;
};

Shape shape_of(const fem::StructuralSystem& system, const Eigen::Matrix3Xd& places, const NodalMotion& motion,
               double amplitude) {
  const fem::Mesh& mesh = system.mesh;
  const Eigen::Matrix<double, 2, 3> view = view_of(system);
  const auto elements = static_cast<int>(mesh.elements.size());
  const int steps = std::max(1, 400 / elements);
  Shape shape;
  for (int e = 0; e < elements; ++e) {
    const ElementPath path(mesh.elements[e], places, motion);
    const bool begins = e == 0 || mesh.elements[e - 1].second != mesh.elements[e].first;
    if (begins && e > 0) shape.undeformed.gap(), shape.deformed.gap();
    for (int step = begins ? 0 : 1; step <= steps; ++step) {
      const double s = static_cast<double>(step) / steps;
      if (step == 0 || step == steps) shape.undeformed.add(view * path.place(s));
      shape.deformed.add(view * (path.place(s) + amplitude * path.displacement(s)));
    }
  }
  return shape;
}

// Between few nodes the curve goes beyond the largest nodal deflection.
void scale(std::vector<double>& deflections) {
  double largest = 0.0;
  for (const double w : deflections) largest = std::max(largest, std::abs(w));
  if (largest > 0.0)
    for (double& w : deflections) w /= largest;
}

bool is_frame(const fem::StructuralSystem& system) {
  return std::any_of(
      system.coordinates.begin(), system.coordinates.end(),
      [](const fem::Coordinate& coordinate) { return coordinate.kind == fem::Coordinate::Kind::axial; });
}

std::string mode_figure_title(Eigen::Index mode, double frequency_hz) {
  if (frequency_hz == 0.0) return fmt::format("mode {}, rigid body", mode + 1);
  const int decimals = std::clamp(4 - static_cast<int>(std::floor(std::log10(frequency_hz))), 0, 9);
  return fmt::format("mode {}, {:.{}f} Hz", mode + 1, frequency_hz, decimals);
}

// Axes of a frame: the same scale along both in a plot of the size [px] that is left of a panel, with room
// for what moves out of it.
std::pair<Axis, Axis> frame_axes(const fem::StructuralSystem& system, const Eigen::Matrix3Xd& places,
                                 double size, double width, double height) {
  const Eigen::Matrix2Xd seen = view_of(system) * places;
  const double x_middle = 0.5 * (seen.row(0).maxCoeff() + seen.row(0).minCoeff());
  const double z_middle = 0.5 * (seen.row(1).maxCoeff() + seen.row(1).minCoeff());
  const double x_span = seen.row(0).maxCoeff() - seen.row(0).minCoeff() + 0.3 * size;
  const double z_span = seen.row(1).maxCoeff() - seen.row(1).minCoeff() + 0.3 * size;
  const double scale = std::max(x_span / width, z_span / height);  // [m/px]
  const auto range = [&](double middle, double pixels) {
    return std::pair{middle - 0.5 * scale * pixels, middle + 0.5 * scale * pixels};
  };
  const bool oblique = system.mesh.spatial;
  return {{oblique ? "across the view [m]" : "x [m]", false, range(x_middle, width)},
          {oblique ? "up [m]" : "y [m]", false, range(z_middle, height)}};
}

// Nodes without a deflection of their own: a filled mark where the rotation is held too, else an open one.
void mark_supports(const fem::StructuralSystem& system, const Eigen::Matrix3Xd& places, Panel& panel) {
  std::vector<bool> deflects(system.mesh.nodes.size()), turns(system.mesh.nodes.size());
  for (const fem::Coordinate& c : system.coordinates) {
    if (c.node < 0) continue;
    if (c.kind == fem::Coordinate::Kind::deflection) deflects[static_cast<std::size_t>(c.node)] = true;
    if (c.kind == fem::Coordinate::Kind::rotation) turns[static_cast<std::size_t>(c.node)] = true;
  }
  for (std::size_t i = 0; i < deflects.size(); ++i) {
    if (deflects[i]) continue;
    const Eigen::VectorXd at = Eigen::VectorXd::Constant(1, places(0, static_cast<Eigen::Index>(i)));
    panel.add(turns[i] ? CurveStyle::open_points : CurveStyle::points, "", at, Eigen::VectorXd::Zero(1),
              Colour::black);
  }
}

/// The axes of all elements as lines, and how each mode moves them.
SwingModel::Part axis_part(const fem::StructuralSystem& system, const Eigen::Matrix3Xd& places,
                           const std::vector<NodalMotion>& modes) {
  const std::vector<fem::Mesh::Element>& elements = system.mesh.elements;
  const auto count = static_cast<int>(elements.size());
  const int steps = std::clamp(240 / std::max(count, 1), 1, 40);
  SwingModel::Part part{SwingModel::Kind::lines, Eigen::Matrix3Xd(3, count * (steps + 1)), {}, {}};
  for (const NodalMotion& motion : modes) {
    Eigen::Matrix3Xd moved(3, part.points.cols());
    for (int e = 0; e < count; ++e) {
      const ElementPath path(elements[static_cast<std::size_t>(e)], places, motion);
      for (int step = 0; step <= steps; ++step) {
        const double s = static_cast<double>(step) / steps;
        part.points.col(e * (steps + 1) + step) = path.place(s);
        moved.col(e * (steps + 1) + step) = path.displacement(s);
      }
    }
    part.motion.push_back(std::move(moved));
  }
  for (int e = 0; e < count; ++e)
    for (int step = 0; step < steps; ++step)
      for (const int end : {0, 1})
        part.corners.push_back(static_cast<unsigned>(e * (steps + 1) + step + end));
  return part;
}

/// Bodies and sections as triangles; too many sections are left out.
SwingModel::Part solid_part(const Picture& picture, const std::vector<NodalMotion>& modes) {
  constexpr std::size_t most_triangles = 4000, most_bytes = 400'000;
  Picture whole = picture;
  whole.surface = picture.beam != nullptr || picture.space_frame != nullptr;
  const BeamGrid grid = beam_grid(whole);
  const auto triangles = [&](bool sections) {
    std::vector<unsigned> corners;
    for (const BeamGrid::Cell& cell : grid.cells)
      for (int k = 1; k + 1 < cell.size && (sections || cell.section == 0); ++k)
        for (const int corner : {0, k, k + 1})
          corners.push_back(
              static_cast<unsigned>(grid.corners[cell.first_corner + static_cast<std::size_t>(corner)]));
    return corners;
  };
  SwingModel::Part part{SwingModel::Kind::triangles, {}, triangles(true), {}};
  const std::size_t bytes = 12 * grid.points.size() * (1 + modes.size()) + 4 * part.corners.size();
  if (part.corners.size() > 3 * most_triangles || bytes > most_bytes) part.corners = triangles(false);
  // Points of sections that are left out go too.
  std::vector<int> number(grid.points.size(), -1);
  std::vector<Eigen::Index> kept;
  for (unsigned& corner : part.corners) {
    if (number[corner] < 0) {
      number[corner] = static_cast<int>(kept.size());
      kept.push_back(static_cast<Eigen::Index>(corner));
    }
    corner = static_cast<unsigned>(number[corner]);
  }
  part.points.resize(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i)
    part.points.col(static_cast<Eigen::Index>(i)) = grid.place(static_cast<std::size_t>(kept[i]));
  for (const NodalMotion& motion : modes)
    part.motion.push_back(translation_of_points(grid, motion)(Eigen::all, kept));
  return part;
}

void check_mode_figure(const fem::StructuralSystem& system, const Eigen::MatrixXd& shapes,
                       const Eigen::VectorXd& frequencies_hz) {
  if (shapes.rows() != system.size() || shapes.cols() != frequencies_hz.size() || shapes.cols() == 0)
    throw std::invalid_argument(
        fmt::format("mode shapes are {} x {}; expected {} x {}, a column for each frequency, one at least",
                    shapes.rows(), shapes.cols(), system.size(), frequencies_hz.size()));
}

/// Orthonormal shapes (n x r) that hold a motion A (n x samples), and the root mean square of the rest over
/// that of all. The range of A A' A W, W having 24 random columns, holds the first singular vectors of A;
/// those of its part B = Q' A, (24 x samples), are exact within it.
std::pair<Eigen::MatrixXd, double> motion_basis(const Eigen::MatrixXd& motion) {
  constexpr Eigen::Index most_columns = 24;
  constexpr double residual_wanted = 1e-3;
  const double energy = motion.squaredNorm();
  const Eigen::Index columns = std::min({most_columns, motion.rows(), motion.cols()});
  std::mt19937 random(1);
  const Eigen::MatrixXd start = Eigen::MatrixXd::NullaryExpr(
      motion.cols(), columns, [&random] { return static_cast<double>(random()) / 2147483648.0 - 1.0; });
  const Eigen::MatrixXd once = motion * start, back = motion.transpose() * once, range = motion * back;
  Eigen::MatrixXd directions = Eigen::MatrixXd::Identity(motion.rows(), columns);
  directions = Eigen::HouseholderQR<Eigen::MatrixXd>(range).householderQ() * directions;
  const Eigen::MatrixXd part = directions.transpose() * motion, gram = part * part.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> values(gram);
  Eigen::Index kept = 0;
  double left = energy;
  while (kept < std::min<Eigen::Index>(columns, most_drawn_modes) &&
         (kept == 0 || left > residual_wanted * residual_wanted * energy))
    left -= values.eigenvalues()[columns - ++kept];
  return {directions * values.eigenvectors().rightCols(kept).rowwise().reverse(),
          energy > 0 ? std::sqrt(std::max(left, 0.0) / energy) : 0.0};
}

}  // namespace

Figure mode_figure(const fem::StructuralSystem& system, const Eigen::MatrixXd& shapes,
                   const Eigen::VectorXd& frequencies_hz) {
  check_mode_figure(system, shapes, frequencies_hz);
  const Eigen::Matrix3Xd places = nodal_places(system);
  const bool frame = is_frame(system);
  const auto modes = static_cast<int>(std::min(shapes.cols(), most_drawn_modes));
  Figure figure;
  figure.name = "mode_shapes";
  figure.columns = modes == 1 ? 1 : frame || modes > 8 ? std::min(modes, 3) : 2;
  figure.rows = (modes + figure.columns - 1) / figure.columns;
  figure.width = modes == 1 ? 500 : frame || modes > 8 ? 1000 : 800;
  const int row_height = frame ? 340 : 240;
  figure.height = figure.rows * row_height;

  const Eigen::Vector3d extent = places.rowwise().maxCoeff() - places.rowwise().minCoeff();
  const double size = extent.maxCoeff();
  std::pair<Axis, Axis> axes{{"x [m]", false, std::pair{places.row(0).minCoeff(), places.row(0).maxCoeff()}},
                             {"deflection (largest 1)", false, std::pair{-1.15, 1.15}}};
  const int panel_width = figure.width / figure.columns;
  if (frame) axes = frame_axes(system, places, size, panel_width - 101.0, row_height - 98.0);
  for (int mode = 0; mode < modes; ++mode) {
    const NodalMotion motion = scaled_mode(system, shapes.col(mode));
    Shape shape = shape_of(system, places, motion, frame ? size / 8 : 1.0);
    if (!frame) scale(shape.deformed.y);
    figure.panels.push_back({mode_figure_title(mode, frequencies_hz[mode]),
                             axes.first,
                             axes.second,
                             {shape.undeformed.curve(Colour::grey)},
                             Legend::none});
    if (!frame) mark_supports(system, places, figure.panels.back());
    figure.panels.back().curves.push_back(shape.deformed.curve(Colour::blue));
  }
  figure.caption =
      frame ? "Mode shapes." : "Mode shapes, largest deflection 1. Filled mark: clamped; open: supported.";
  return figure;
}

SwingModel mode_model(const Picture& picture, const Eigen::MatrixXd& shapes,
                      const Eigen::VectorXd& frequencies_hz) {
  const fem::StructuralSystem& system = picture.system;
  check_mode_figure(system, shapes, frequencies_hz);
  const Eigen::Matrix3Xd places = nodal_places(system);
  std::vector<NodalMotion> motions;
  SwingModel model;
  for (int mode = 0; mode < std::min(shapes.cols(), most_drawn_modes); ++mode) {
    motions.push_back(scaled_mode(system, shapes.col(mode)));
    model.modes.push_back(
        {mode_figure_title(mode, frequencies_hz[mode]), frequencies_hz[mode], {}, mode, {}});
  }
  if (SwingModel::Part solid = solid_part(picture, motions); !solid.corners.empty())
    model.parts.push_back(std::move(solid));
  model.parts.push_back(axis_part(system, places, motions));
  return model;
}

std::pair<SwingModel, MotionHistory> motion_model(const Picture& picture, const Eigen::VectorXd& time,
                                                  const Eigen::MatrixXd& displacement) {
  const fem::StructuralSystem& system = picture.system;
  if (displacement.rows() != system.size() || displacement.cols() != time.size() || time.size() == 0)
    throw std::invalid_argument(fmt::format("a motion of {} x {}; expected {} x {}, one sample at least",
                                            displacement.rows(), displacement.cols(), system.size(),
                                            time.size()));
  const auto [basis, residual] = motion_basis(displacement);
  const Eigen::Matrix3Xd places = nodal_places(system);
  MotionHistory history{time, basis.transpose() * displacement, 0.0, 100.0 * residual};
  std::vector<NodalMotion> motions;
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    motions.push_back(nodal_motion(system, basis.col(k)));
    NodalMotion& motion = motions.back();
    const double size = motion.translation.colwise().norm().maxCoeff();
    if (!(size > 0.0)) continue;
    motion.translation /= size;
    motion.rotation /= size;
    history.weights.row(k) *= size;
  }
  for (Eigen::Index sample = 0; sample < time.size(); ++sample) {
    Eigen::Matrix3Xd moved = Eigen::Matrix3Xd::Zero(3, places.cols());
    for (std::size_t k = 0; k < motions.size(); ++k)
      moved += history.weights(static_cast<Eigen::Index>(k), sample) * motions[k].translation;
    history.largest = std::max(history.largest, moved.colwise().norm().maxCoeff());
  }
  SwingModel model;
  if (SwingModel::Part solid = solid_part(picture, motions); !solid.corners.empty())
    model.parts.push_back(std::move(solid));
  model.parts.push_back(axis_part(system, places, motions));
  return {std::move(model), std::move(history)};
}

Curve mode_curve(const fem::StructuralSystem& system, const Eigen::VectorXd& shape) {
  const Shape drawn = shape_of(system, nodal_places(system), scaled_mode(system, shape), 1.0);
  ModeLine line = drawn.deformed;
  scale(line.y);
  return line.curve(Colour::automatic);
}

}  // namespace beamid::experiments
