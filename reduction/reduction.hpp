// Fewer coordinates: an assumed set of shapes and the projection of the equations on them.
#pragma once

#include <memory>
#include <string>

#include <Eigen/Core>

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
  Eigen::MatrixXd shapes;  ///< empty when they are the identity

  /// How much each shape carries, where the method says so: Hankel singular values, singular values of the
  /// snapshots. All that were found, not only the r that are kept; empty where the method has none.
  Eigen::VectorXd significance = {};
  std::string significance_name = {};  ///< with its unit: "Hankel singular value [m/N]"

  bool identity = false;  ///< Phi = I, which nobody should have to store or multiply by
};

/// A way to choose shapes for a system.
class Reduction {
 public:
  virtual ~Reduction() = default;
  /// @param training what a method learns from, for those that do; the others do not look at it.
  /// @throws std::invalid_argument when the system cannot be reduced this way, or training is missing.
  virtual Bases bases(const fem::StructuralSystem& system, const Training& training = {}) const = 0;
  /// Whether the r shapes span the r lowest modes of whatever system, and nothing else: a model may then let
  /// them follow what is asked about the system.
  virtual bool spans_lowest_modes() const { return false; }
};

/// A small system and the way back to the mesh.
struct ReducedModel {
  fem::StructuralSystem system;  ///< r generalised coordinates; the full system itself when identity
  Eigen::MatrixXd shapes;        ///< Phi (n x r); empty when identity
  bool identity = false;         ///< nothing was reduced, Phi = I

  /// Motion on the mesh, Phi z (n x k), of the columns of z (r x k), real or complex.
  template <class Derived>
  typename Derived::PlainObject lift(const Eigen::MatrixBase<Derived>& z) const {
    if (identity) return z;
    return shapes * z;
  }

  /// Phi (n x r), the identity written out.
  Eigen::MatrixXd dense_shapes() const {
    if (identity) return Eigen::MatrixXd::Identity(system.size(), system.size());
    return shapes;
  }
};

/// Galerkin projection: M_r = Phi^T M Phi, C_r = Phi^T C Phi, E_r = Phi^T E, H_r = H Phi, and the stiffness
/// kept as a factor, K_r = R^T R from the QR decomposition D^1/2 B Phi = Q R, so that it never cancels
/// (unless an axial load makes D indefinite: then R is the Cholesky factor of K_r). What the shapes have of
/// rigid-body motion is taken off before, and R has a row less for each rigid-body motion among them. Bases
/// that are the identity give the system itself, at no cost.
/// @throws std::invalid_argument when shapes do not fit the system, are not finite or depend on each other,
/// or an axial load buckles the structure.
ReducedModel project(const fem::StructuralSystem& system, const Bases& bases);

/// bases + project.
ReducedModel reduce(const fem::StructuralSystem& system, const Reduction& reduction,
                    const Training& training = {});

/// Contracts a reduction may declare; the conformance tests hold it to them.
namespace contract {
inline constexpr const char* static_exact = "static_exact";  ///< exact deflection under a static tip force
inline constexpr const char* modes_exact = "modes_exact";    ///< its r frequencies are the system's r lowest
inline constexpr const char* complete = "complete";          ///< no approximation at all
/// Keeps the rigid-body motions of a free structure, where two points are known.
inline constexpr const char* rigid_exact = "rigid_exact";
/// Grows by one coordinate with option `modes` (or `moments`), up to the full size and the full system.
inline constexpr const char* grows = "grows";
}  // namespace contract

using ReductionRegistry = filters::Registry<Reduction>;
ReductionRegistry& reduction_registry();

// A shape known at some points, spread over the mesh.

/// Shapes S (n x p) such that S d is the motion of least strain energy through the deflections d (p) of the
/// training's points; supports hold. Between nodes the deflection is Hermite's cubic of the element's ends;
/// for slender uniform elements that is exactly how they bend. A point that a support holds has a zero
/// column.
/// @param owner for messages: "reduction 'pod'".
/// @throws std::invalid_argument when training is empty, of inconsistent sizes, not finite or zero, a point
/// is off the beam, given twice or said to move where a support holds it, the points do not hold the
/// structure's rigid-body motions, or the system has no mesh or is a frame.
Eigen::MatrixXd static_interpolation(const fem::StructuralSystem& system, const Training& training,
                                     const std::string& owner);

}  // namespace beamid::reduction
