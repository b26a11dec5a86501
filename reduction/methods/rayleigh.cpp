// Rayleigh's equivalent mass [rayleigh1877]: one coordinate, the tip deflection, and one assumed shape.
//
//     static_tip_load   w = (3 L x^2 - x^3) / (2 L^3)     mass 33/140 m + M, stiffness 3 EI / L^3
//     one_minus_cosine  w = 1 - cos(pi x / (2 L))         mass (3/2 - 4/pi) m + M, stiffness pi^4 EI / (32
//     L^3)
//
// Neither number is written here: both come out of the projection.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "fem/stiffness_solver.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

// Nodal values and slopes of 1 - cos(pi x / (2 L)), L being the position of the last node.
Eigen::VectorXd one_minus_cosine(const fem::StructuralSystem& system) {
  double length = 0.0;
  for (const auto& coordinate : system.coordinates) length = std::max(length, coordinate.position);
  const double wave = 0.5 * std::numbers::pi / length;
  Eigen::VectorXd shape(system.size());
  for (Eigen::Index i = 0; i < system.size(); ++i) {
    const fem::Coordinate& coordinate = system.coordinates[i];
    const auto kind = coordinate.kind;
    const double x = coordinate.position, scale = coordinate.scale;
    if (kind == fem::Coordinate::Kind::generalised)
      throw std::invalid_argument("reduction 'rayleigh' needs a mesh for shape 'one_minus_cosine'");
    const bool deflection = kind == fem::Coordinate::Kind::deflection;
    shape[i] = scale * (deflection ? 1.0 - std::cos(wave * x) : wave * std::sin(wave * x));
  }
  return shape;
}

class Rayleigh final : public Reduction {
 public:
  explicit Rayleigh(std::string shape) : shape_(std::move(shape)) {
    if (shape_ != "static_tip_load" && shape_ != "one_minus_cosine")
      throw std::invalid_argument("unknown shape '" + shape_ +
                                  "' of reduction 'rayleigh'; known: " + "one_minus_cosine, static_tip_load");
  }

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    return {shape_ == "static_tip_load" ? fem::static_shape(system) : one_minus_cosine(system)};
  }

 private:
  std::string shape_;
};

const bool registered = reduction_registry().add(
    {"rayleigh",
     "one coordinate, the tip deflection, with an assumed shape (equivalent mass)",
     "[rayleigh1877]",
     {{"shape", "static_tip_load", "", "static_tip_load or one_minus_cosine"}},
     {},
     [](const filters::Options& options) { return std::make_unique<Rayleigh>(options.text("shape")); }});

}  // namespace
}  // namespace beamid::reduction
