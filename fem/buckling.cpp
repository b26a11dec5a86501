#include "fem/buckling.hpp"

#include <Eigen/Dense>
#include <vector>

#include "fem/assembly.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem {

using Eigen::MatrixXd;

namespace {

constexpr double rounding = 1e-11;  // of what a load softens, relative to what it stiffens

// Coordinates that K couples with others or that lose stiffness: those inside elements mostly do neither.
std::vector<Eigen::Index> concerned(const SparseMatrix& full, const SparseMatrix& softened) {
  std::vector<Eigen::Index> found;
  for (Eigen::Index column = 0; column < full.cols(); ++column) {
    bool any = full.coeff(column, column) != softened.coeff(column, column);
    for (const SparseMatrix* const stiffness : {&full, &softened})
      for (SparseMatrix::InnerIterator it(*stiffness, column); it && !any; ++it)
        any = it.row() != column && it.value() != 0.0;
    if (any) found.push_back(column);
  }
  return found;
}

// The least positive x with det(K + x G) = 0; G is how K changes.
std::optional<double> first_loss(const StrainFactors& unloaded, const StrainFactors& loaded) {
  if (StiffnessSolver(unloaded).rigid_motions().cols() > 0) return std::nullopt;
  const SparseMatrix whole = unloaded.assembled(), softened = loaded.assembled();
  const std::vector<Eigen::Index> kept = concerned(whole, softened);
  if (kept.empty()) return std::nullopt;
  const MatrixXd full = MatrixXd(whole)(kept, kept), softening = full - MatrixXd(softened)(kept, kept);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(softening, full, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return std::nullopt;
  const double largest = solver.eigenvalues().tail(1)[0], stiffening = -solver.eigenvalues()[0];
  if (!(largest > rounding * stiffening)) return std::nullopt;
  return 1.0 / largest;
}

template <class AnyFrame>
std::optional<double> factor_of_loads(const AnyFrame& frame, int elements_per_member) {
  AnyFrame unloaded = frame;
  for (auto& member : unloaded.members) member.axial_load = 0.0;
  return first_loss(assemble(unloaded, elements_per_member).stiffness,
                    assemble(frame, elements_per_member).stiffness);
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
  return factor_of_loads(frame, elements_per_member);
}

std::optional<double> buckling_factor(const SpaceFrame& frame, int elements_per_member) {
  return factor_of_loads(frame, elements_per_member);
}

}  // namespace beamid::fem
