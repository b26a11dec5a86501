// Fewer coordinates: an assumed set of shapes and the projection of the equations on them.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "fem/structural_system.hpp"
#include "filters/registry.hpp"

namespace beamid::reduction {

/// Deflections seen at some points: a shape from a file (N = 1), or a response for the POD.
struct Training {
  Eigen::VectorXd positions;    ///< (p) [m] along the beam
  Eigen::MatrixXd deflections;  ///< (p x N), a column per instant; only their ratios matter

  bool empty() const { return deflections.size() == 0; }
};

/// Shapes Phi (n x r): the full motion is assumed to be q = Phi z.
struct Bases {
  Eigen::MatrixXd shapes;

  /// How much each shape carries, where the method says so: Hankel singular values, singular values of the
  /// snapshots. All that were found, not only the r that are kept; empty where the method has none.
  Eigen::VectorXd significance = {};
  std::string significance_name = {};  ///< with its unit: "Hankel singular value [m/N]"
};

/// A way to choose shapes for a system.
class Reduction {
 public:
  virtual ~Reduction() = default;
  /// @param training what a method learns from, for those that do; the others do not look at it.
  /// @throws std::invalid_argument when the system cannot be reduced this way, or training is missing.
  virtual Bases bases(const fem::StructuralSystem& system, const Training& training = {}) const = 0;
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
ReducedModel reduce(const fem::StructuralSystem& system, const Reduction& reduction,
                    const Training& training = {});

/// Contracts a reduction may declare; the conformance tests hold it to them.
namespace contract {
inline constexpr const char* static_exact = "static_exact";  ///< exact deflection under a static tip force
inline constexpr const char* modes_exact = "modes_exact";    ///< its r frequencies are the system's r lowest
inline constexpr const char* complete = "complete";          ///< no approximation at all
}  // namespace contract

using ReductionRegistry = filters::Registry<Reduction>;
ReductionRegistry& reduction_registry();

}  // namespace beamid::reduction
