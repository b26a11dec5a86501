#include "experiments/identify/twins/set_modes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <numbers>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t most_sensor_places = 10;

// Coordinates that are deflections, and what multiplies a displacement there.
std::vector<std::pair<Index, double>> deflections_in(const ModalModel& model) {
  std::vector<std::pair<Index, double>> found;
  using Kind = fem::Coordinate::Kind;
  const auto& coordinates = model.described().system.coordinates;
  const bool spatial = model.structure().space_frame() != nullptr;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (const Kind kind = coordinates[i].kind;
        kind == Kind::deflection || (spatial && (kind == Kind::axial || kind == Kind::lateral)))
      found.emplace_back(static_cast<Index>(i), coordinates[i].scale);
  return found;
}

// A joint of a frame by its name, a place between joints by where it is.
std::string place_text(const ModalModel& model, Index coordinate) {
  const fem::StructuralSystem& system = model.described().system;
  const fem::Coordinate& there = system.coordinates[static_cast<std::size_t>(coordinate)];
  if (const fem::MatrixSystem* const matrices = model.structure().matrices())
    return matrices->labels[static_cast<std::size_t>(coordinate)];
  if (const fem::Frame* const frame = model.structure().frame()) {
    const auto node = static_cast<std::size_t>(there.node);
    if (node < frame->joints.size())
      return (frame->joints[node].name.empty() ? fmt::format("{}", node + 1) : frame->joints[node].name) +
             ".y";
    return fmt::format("({:.3g} m, {:.3g} m).y", system.mesh.nodes[node].x, system.mesh.nodes[node].y);
  }
  if (const fem::SpaceFrame* const frame = model.structure().space_frame()) {
    using Kind = fem::Coordinate::Kind;
    const char axis = there.kind == Kind::axial ? 'x' : there.kind == Kind::deflection ? 'y' : 'z';
    const auto node = static_cast<std::size_t>(there.node);
    const fem::Mesh::Node& at = system.mesh.nodes[node];
    if (node >= frame->joints.size())
      return fmt::format("({:.3g} m, {:.3g} m, {:.3g} m).{}", at.x, at.y, at.z, axis);
    const std::string& name = frame->joints[node].name;
    return fmt::format("{}.{}", name.empty() ? fmt::format("{}", node + 1) : name, axis);
  }
  return fmt::format("{:.4g} m", there.position);
}

VectorXd frequencies_of(const VectorXd& eigenvalues) {
  return eigenvalues.cwiseMax(0.0).cwiseSqrt() / (2.0 * std::numbers::pi);
}

}  // namespace

SetModes set_modes(const ModalModel& model, const VectorXd& values, std::size_t count) {
  const auto [mass, stiffness] = model.matrices(values);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, mass);
  const Index kept = std::min(model.size(), static_cast<Index>(count));
  SetModes modes;
  modes.frequency_hz = frequencies_of(solver.eigenvalues().head(kept));
  const auto deflections = deflections_in(model);
  const std::size_t step =
      std::max<std::size_t>(1, (deflections.size() + most_sensor_places - 1) / most_sensor_places);
  std::vector<double> scales;
  for (std::size_t i = deflections.size(); i > 0; i -= std::min(i, step)) {  // the last one first: the tip
    const auto& [coordinate, scale] = deflections[i - 1];
    modes.coordinates.insert(modes.coordinates.begin(), coordinate);
    scales.insert(scales.begin(), scale);
    modes.places.insert(modes.places.begin(), place_text(model, coordinate));
  }
  modes.shapes.resize(static_cast<Index>(scales.size()), kept);
  for (Index a = 0; a < modes.shapes.rows(); ++a)
    modes.shapes.row(a) =
        solver.eigenvectors().row(modes.coordinates[static_cast<std::size_t>(a)]).head(kept) /
        scales[static_cast<std::size_t>(a)];
  return modes;
}

double translated_mass(const ModalModel& model, const VectorXd& values) {
  VectorXd motion = VectorXd::Zero(model.size());
  for (const auto& [coordinate, scale] : deflections_in(model)) motion[coordinate] = scale;
  return motion.dot(model.matrices(values).first * motion);
}

VectorXd frequencies_with_mass(const ModalModel& model, const VectorXd& values, Index coordinate,
                               double mass) {
  auto [matrix, stiffness] = model.matrices(values);
  const double scale = model.described().system.coordinates[static_cast<std::size_t>(coordinate)].scale;
  matrix(coordinate, coordinate) += mass / (scale * scale);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, matrix, Eigen::EigenvaluesOnly);
  return frequencies_of(solver.eigenvalues());
}

}  // namespace beamid::experiments
