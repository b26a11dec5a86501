#include "fem/buckling.hpp"

#include <Eigen/Dense>

#include "fem/assembly.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem {

using Eigen::MatrixXd;

namespace {

// The least positive x with det(K + x G) = 0; G is how K changes.
std::optional<double> first_loss(const StrainFactors& unloaded, const StrainFactors& loaded) {
  if (StiffnessSolver(unloaded).rigid_motions().cols() > 0) return std::nullopt;
  const MatrixXd full(unloaded.assembled()), softening = full - MatrixXd(loaded.assembled());
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(softening, full, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().tail(1)[0];
  if (solver.info() != Eigen::Success || !(largest > 0.0)) return std::nullopt;
  return 1.0 / largest;
}

}  // namespace

std::optional<double> buckling_load(const Beam& beam, int elements) {
  const auto stiffness = [&](double load) {
    Beam loaded = beam;
    loaded.axial_load = load;
    return assemble(loaded, elements).stiffness;
  };
  // K is linear in P: any load of the size that matters will do.
  const double length = beam.length(),
               load = beam.segments.front().section.bending_stiffness(0.5) / (length * length);
  const auto factor = first_loss(stiffness(0.0), stiffness(load));
  return factor ? std::optional(*factor * load) : std::nullopt;
}

std::optional<double> buckling_factor(const Frame& frame, int elements_per_member) {
  Frame unloaded = frame;
  for (Frame::Member& member : unloaded.members) member.axial_load = 0.0;
  return first_loss(assemble(unloaded, elements_per_member).stiffness,
                    assemble(frame, elements_per_member).stiffness);
}

}  // namespace beamid::fem
