// Craig and Bampton's component modes [craig1968]: the interface, held in deflection and rotation, is kept as
// it is; the inside is a static shape per interface coordinate and the lowest modes with the interface fixed,
//
//     Phi = [     I           0    ]   interface
//           [ -K_ii^-1 K_ib   U_i  ]   inside
//
// Exact under static loads on the interface, and in every motion when all fixed-interface modes are kept.
#include "fem/modes.hpp"
#include "reduction/constrained_statics.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

using Eigen::Index, Eigen::MatrixXd;

const std::string craig_bampton_owner = "reduction 'craig_bampton'";

// Modes of the system with the coordinates not in `inside` at rest, on all coordinates (n x count).
MatrixXd fixed_interface_modes(const fem::StructuralSystem& system, const std::vector<int>& inside,
                               Index count) {
  const auto selection = unit_rows(inside, system.size());
  const fem::SparseMatrix into = selection.transpose();
  fem::StructuralSystem fixed;
  fixed.mass = selection * system.mass * into;
  fixed.stiffness = system.stiffness;
  fixed.stiffness.strain = system.stiffness.strain * into;
  MatrixXd shapes = MatrixXd::Zero(system.size(), count);
  shapes(inside, Eigen::all) = fem::modes(fixed, count).shape;
  return shapes;
}

class CraigBampton final : public Reduction {
 public:
  explicit CraigBampton(const filters::Options& options)
      : interface_(options.numbers("interface_m")),
        modes_(count_option(options, "modes", "craig_bampton", 0)) {}

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    const std::vector<int> boundary = interface_coordinates(system, interface_, craig_bampton_owner);
    std::vector<bool> is_boundary(static_cast<std::size_t>(system.size()), false);
    for (const int coordinate : boundary) is_boundary[coordinate] = true;
    std::vector<int> inside;
    for (int i = 0; i < system.size(); ++i)
      if (!is_boundary[i]) inside.push_back(i);
    require_at_most(modes_, static_cast<Index>(inside.size()), "modes", "craig_bampton");

    const auto constraints = static_cast<Index>(boundary.size());
    MatrixXd shapes(system.size(), constraints + modes_);
    shapes.leftCols(constraints) =
        ConstrainedStatics(system, unit_rows(boundary, system.size()), craig_bampton_owner).unit_shapes();
    if (modes_ > 0) shapes.rightCols(modes_) = fixed_interface_modes(system, inside, modes_);
    return {shapes};
  }

 private:
  std::vector<double> interface_;
  Index modes_;
};

const bool craig_bampton_registered = reduction_registry().add(
    {"craig_bampton",
     "an interface kept as it is, and modes of the rest with the interface fixed",
     "[craig1968]",
     {{"interface_m", std::vector<double>{}, "m", "positions of the interface; none: where the outputs are"},
      {"modes", 1.0, "", "number of fixed-interface modes kept"}},
     {contract::static_exact, contract::rigid_exact, contract::grows},
     [](const filters::Options& options) { return std::make_unique<CraigBampton>(options); }});

}  // namespace
}  // namespace beamid::reduction
