// Rayleigh's equivalent mass [rayleigh1877]: one coordinate, the deflection at the first output, and one
// assumed shape. On a uniform cantilever with a tip mass M,
//
//     static_tip_load   w = (3 L x^2 - x^3) / (2 L^3)   mass 33/140 m + M, stiffness 3 EI / L^3
//     one_minus_cosine  w = 1 - cos(pi x / (2 L))       (3/2 - 4/pi) m + M, pi^4 EI / (32 L^3)
//     self_weight       static under its own weight, that of the tip mass included
//     given             through deflections given at some points, by least strain energy in between
//
// None of these numbers is written here: they come out of the projection.
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "reduction/constrained_statics.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

using Eigen::VectorXd;
using Kind = fem::Coordinate::Kind;

const std::string rayleigh_owner = "reduction 'rayleigh'";

VectorXd static_deflection(const fem::StructuralSystem& system, int input, const std::string& shape) {
  if (input < 0)
    throw std::invalid_argument(rayleigh_owner + ": the system has no input that makes shape '" + shape +
                                "'");
  const ElasticStatics statics(system);
  if (statics.rigid_modes().cols() > 0)
    throw std::invalid_argument(rayleigh_owner + ": the structure can move without strain; shape '" + shape +
                                "' needs supports that hold it");
  return statics.solve(system.inputs.col(input));
}

VectorXd static_tip_load(const fem::StructuralSystem& system) {
  const std::vector<int> forces = force_inputs(system);
  return static_deflection(system, forces.empty() ? -1 : forces.front(), "static_tip_load");
}

// w and theta of 1 - cos(pi x / (2 L)).
double cosine_shape(Kind kind, double x, double length) {
  const double wave = 0.5 * std::numbers::pi / length;
  return kind == Kind::deflection ? 1.0 - std::cos(wave * x) : wave * std::sin(wave * x);
}

// Supports must hold nothing that the shape moves: elsewhere than at a clamped root it is no shape of the
// beam.
void require_cosine_fits(const fem::StructuralSystem& system, double length) {
  for (const Kind kind : {Kind::deflection, Kind::rotation}) {
    std::vector<bool> free(system.mesh.nodes.size(), false);
    for (const fem::Coordinate& coordinate : system.coordinates)
      if (coordinate.kind == kind) free[coordinate.node] = true;
    for (std::size_t node = 0; node < free.size(); ++node) {
      const double x = system.mesh.nodes[node].x;
      if (free[node] || cosine_shape(kind, x, length) == 0.0) continue;
      std::ostringstream message;
      message << rayleigh_owner << ": shape 'one_minus_cosine' moves x = " << x
              << " m, which a support holds; expected a beam that is held at its root only";
      throw std::invalid_argument(message.str());
    }
  }
}

// What is inside elements, or hangs on them, follows the nodes statically.
VectorXd one_minus_cosine(const fem::StructuralSystem& system) {
  if (system.mesh.nodes.empty())
    throw std::invalid_argument(rayleigh_owner + " needs a mesh for shape 'one_minus_cosine'");
  const double length = system.mesh.positions().maxCoeff();
  VectorXd shape = VectorXd::Zero(system.size());
  std::vector<int> nodal;
  for (int i = 0; i < system.size(); ++i) {
    const fem::Coordinate& coordinate = system.coordinates[i];
    if (coordinate.kind == Kind::axial)
      throw std::invalid_argument(rayleigh_owner +
                                  ": shape 'one_minus_cosine' is one of a beam, not of a frame");
    if (coordinate.kind == Kind::generalised) continue;
    shape[i] = coordinate.scale * cosine_shape(coordinate.kind, coordinate.position, length);
    nodal.push_back(i);
  }
  require_cosine_fits(system, length);
  if (static_cast<Eigen::Index>(nodal.size()) == system.size()) return shape;
  const ConstrainedStatics statics(system, unit_rows(nodal, system.size()), rayleigh_owner);
  return statics.unit_shapes() * shape(nodal);
}

VectorXd given(const fem::StructuralSystem& system, const Training& training) {
  if (training.deflections.cols() != 1)
    throw std::invalid_argument(rayleigh_owner + ": shape 'given' has " +
                                std::to_string(training.deflections.cols()) +
                                " columns of deflections; expected 1");
  return static_interpolation(system, training, rayleigh_owner) * training.deflections;
}

// To 1 at the first output, so that the mass is the equivalent mass there.
VectorXd scaled(const fem::StructuralSystem& system, const VectorXd& shape) {
  if (system.outputs.rows() == 0) return shape;
  const double seen = (system.outputs * shape)[0];
  if (!(std::abs(seen) > 1e-9 * shape.cwiseAbs().maxCoeff()))
    throw std::invalid_argument(rayleigh_owner +
                                ": the shape does not move the first output; expected another shape");
  return shape / seen;
}

class Rayleigh final : public Reduction {
 public:
  explicit Rayleigh(std::string shape) : shape_(std::move(shape)) {
    for (const char* known : {"static_tip_load", "one_minus_cosine", "self_weight", "given"})
      if (shape_ == known) return;
    throw std::invalid_argument("unknown shape '" + shape_ +
                                "' of reduction 'rayleigh'; known: given, one_minus_cosine, self_weight, "
                                "static_tip_load");
  }

  Bases bases(const fem::StructuralSystem& system, const Training& training) const override {
    return {scaled(system, shape(system, training))};
  }

 private:
  std::string shape_;

  VectorXd shape(const fem::StructuralSystem& system, const Training& training) const {
    if (shape_ == "static_tip_load") return static_tip_load(system);
    if (shape_ == "one_minus_cosine") return one_minus_cosine(system);
    if (shape_ == "self_weight") return static_deflection(system, base_input(system), shape_);
    return given(system, training);
  }
};

const bool rayleigh_registered = reduction_registry().add(
    {"rayleigh",
     "one coordinate, the tip deflection, with an assumed shape (equivalent mass)",
     "[rayleigh1877]",
     {{"shape", "static_tip_load", "", "static_tip_load, one_minus_cosine, self_weight or given"}},
     {contract::static_exact},
     [](const filters::Options& options) { return std::make_unique<Rayleigh>(options.text("shape")); }});

}  // namespace
}  // namespace beamid::reduction
