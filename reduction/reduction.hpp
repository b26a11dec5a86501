// Fewer coordinates: an assumed set of shapes and the projection of the equations on them.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "fem/structural_system.hpp"
#include "filters/registry.hpp"

namespace beamid::reduction {

/// Shapes Phi (n x r): the full motion is assumed to be q = Phi z.
struct Bases {
  Eigen::MatrixXd shapes;
};

/// A way to choose shapes for a system.
class Reduction {
 public:
  virtual ~Reduction() = default;
  /// @throws std::invalid_argument when the system cannot be reduced this way.
  virtual Bases bases(const fem::StructuralSystem& system) const = 0;
};

/// A small system and the way back to the mesh.
struct ReducedModel {
  fem::StructuralSystem system;  ///< r generalised coordinates
  Eigen::MatrixXd shapes;        ///< Phi (n x r)

  /// Motion on the mesh, Phi z (n).
  Eigen::VectorXd lift(const Eigen::VectorXd& z) const { return shapes * z; }
};

/// Galerkin projection: M_r = Phi^T M Phi, C_r = Phi^T C Phi, E_r = Phi^T E, H_r = H Phi, and the stiffness
/// kept as a factor, K_r = R^T R from the QR decomposition D^1/2 B Phi = Q R, so that it never cancels
/// (unless an axial load makes D indefinite: then R is the Cholesky factor of K_r).
/// @throws std::invalid_argument when shapes do not fit the system or depend on each other.
ReducedModel project(const fem::StructuralSystem& system, const Bases& bases);

/// bases + project.
ReducedModel reduce(const fem::StructuralSystem& system, const Reduction& reduction);

/// Contracts a reduction may declare; the conformance tests hold it to them.
namespace contract {
inline constexpr const char* static_exact = "static_exact";  ///< exact deflection under a static tip force
inline constexpr const char* modes_exact = "modes_exact";    ///< its r frequencies are the system's r lowest
inline constexpr const char* complete = "complete";          ///< no approximation at all
}  // namespace contract

using ReductionRegistry = filters::Registry<Reduction>;
ReductionRegistry& reduction_registry();

}  // namespace beamid::reduction
