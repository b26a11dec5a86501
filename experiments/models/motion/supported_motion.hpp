// A structure, or a part of one, some of whose points move as was measured there.
#pragma once

#include <memory>
#include <vector>

#include "experiments/models/motion/second_order_motion.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments {

/// The n coordinates of a part, those inside first, then its b supports, whose accelerations are inputs:
///
///     M z'' + C z' + K z = E u,    rows of a support: z_s'' = a_s - share_s a_base
///
/// a_s in units of its coordinate, of a beam's rotation s theta''.
/// Coordinates are those of the structure, relative to its base. What lies beyond the supports has no part
/// in it: it acts through their motion alone, which is what makes a substructure of a structure.
struct SupportedEquations {
  std::vector<Eigen::Index> coordinates;  ///< of the structure, n - b inside, then the b supports
  Eigen::Index supports = 0;              ///< b
  Eigen::MatrixXd mass, damping,
      stiffness;           ///< at p_0 (n x n); rows of supports: those of the identity, 0, 0
  Eigen::MatrixXd inputs;  ///< E at p_0 (n x m)

  struct Derivative {
    Eigen::MatrixXd mass, damping, stiffness, inputs;  ///< likewise; rows of supports are 0
  };
  std::vector<Derivative> derivatives;  ///< a

  Eigen::Index inside() const { return mass.rows() - supports; }
};

/// The part between the supports in which the outputs lie: coordinates that are connected to an output
/// without passing a support.
/// @param forces inputs of the system that are measured (m); @param supports which of them are imposed
/// accelerations; @param base which of them is the acceleration of the base, -1: none
/// @throws std::invalid_argument where a support is no coordinate of its own, or nothing lies inside; the
/// part has more than 60 coordinates.
SupportedEquations supported_equations(const fem::ParametricSystem& equations,
                                       const std::vector<Eigen::Index>& forces,
                                       const std::vector<Eigen::Index>& supports, Eigen::Index base);

/// Which coordinates are connected to some of them without passing a support (n).
/// @param from and @param supports inputs of the system
std::vector<bool> connected_inside(const fem::StructuralSystem& system, const std::vector<Eigen::Index>& from,
                                   const std::vector<Eigen::Index>& supports);

/// The one coordinate that a force at this input moves. @throws std::invalid_argument where it moves several.
Eigen::Index coordinate_of(const fem::StructuralSystem& system, Eigen::Index input);

/// The part with its supports at rest: K, M and their derivatives (n - b).
fem::ParametricSystem held_at_supports(const fem::ParametricSystem& equations,
                                       const SupportedEquations& part);

class SupportedMotion final : public SecondOrderMotion {
 public:
  /// @param rows what the observations read of the part's coordinates (p x n)
  /// @param frequencies typical of each coordinate [rad/s] (n), positive
  SupportedMotion(SupportedEquations equations, MotionDescription description, Eigen::MatrixXd rows,
                  Eigen::VectorXd frequencies);

  void evaluate(const Eigen::VectorXd& state, SecondOrderForm& form,
                std::vector<SecondOrderForm>* slopes) const override;
  Eigen::Index supports() const { return equations_.supports; }
  bool decoupled() const override { return false; }
  bool has_modes_of_its_own() const override { return false; }
  Eigen::VectorXd frequencies() const override { return frequencies_; }

 private:
  SupportedEquations equations_;
  Eigen::VectorXd frequencies_;

  std::shared_ptr<const SecondOrderMotion> copy() const override {
    return std::make_shared<SupportedMotion>(*this);
  }
};

}  // namespace beamid::experiments
