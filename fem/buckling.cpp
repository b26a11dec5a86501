#include "fem/buckling.hpp"

#include <Eigen/Dense>

#include "fem/assembly.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem {

using Eigen::MatrixXd;

std::optional<double> buckling_load(const Beam& beam, int elements) {
  const auto stiffness = [&](double load) {
    Beam loaded = beam;
    loaded.axial_load = load;
    return assemble(loaded, elements).stiffness;
  };
  const StrainFactors unloaded = stiffness(0.0);
  if (StiffnessSolver(unloaded).rigid_motions().cols() > 0) return std::nullopt;
  // K is linear in P: any load of the size that matters gives G.
  const double length = beam.length(),
               load = beam.segments.front().section.bending_stiffness(0.5) / (length * length);
  const MatrixXd full(unloaded.assembled()),
      geometric = (full - MatrixXd(stiffness(load).assembled())) / load;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(geometric, full, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().tail(1)[0];
  if (solver.info() != Eigen::Success || !(largest > 0.0)) return std::nullopt;
  return 1.0 / largest;
}

}  // namespace beamid::fem
