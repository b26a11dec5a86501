// The joint state of a whole structure, every coordinate of its mesh, at a cost per step that grows with its
// size and no faster.
//
//     z = [q, q', offsets that drift, eta, constant offsets],    M(p) q'' + C(p) q' + K(p) q = E(p) f
//
// All matrices are sparse, along a beam narrow bands, but for the damping of single modes, which is of low
// rank. One step of the scheme `pade` is one complex symmetric system (banded_step.hpp); with r directions it
// costs O(n r) of a beam, a chain or a frame, whose members are chains.
#pragma once

#include <memory>
#include <string>

#include "experiments/models/motion/parametric_motion.hpp"
#include "fem/parametric_system.hpp"
#include "filters/continuous_model.hpp"

namespace beamid::experiments {

/// The continuum with unknown parameters. It moves in time by `pade`, and only small meshes by other schemes,
/// for these form dense matrices.
class ContinuumMotion final : public filters::ContinuousModel {
 public:
  /// @param equations M, D, E and their derivatives by the properties that `description` drives; output row i
  /// of the system is what observation i reads; its damping is C_0.
  /// @param name of the coordinates in state labels
  /// @throws std::invalid_argument when sizes do not fit, the system has nonlinear forces, or an observation
  /// is a force.
  ContinuumMotion(fem::ParametricSystem equations, MotionDescription description,
                  const std::string& name = "coordinate");
  ~ContinuumMotion() override;

  Eigen::Index input_size() const override;
  std::vector<filters::Label> state_labels() const override;
  std::vector<filters::Label> output_labels() const override;

  void rate(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& rate) const override;
  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
              Eigen::VectorXd& output) const override;
  /// Analytic, as are the tangents of the step.
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) const override;

  /// The banded step for `pade`; null for other schemes up to `dense_limit` coordinates.
  /// @throws std::invalid_argument for other schemes beyond, saying what to use instead.
  std::unique_ptr<filters::DiscreteModel> structured(double dt, const std::string& scheme,
                                                     const filters::Noise& noise) const override;

  static constexpr Eigen::Index dense_limit = 100;

  struct Parts;  ///< what the continuous model and its discretisations share

 private:
  std::shared_ptr<const Parts> parts_;
};

/// Whether the shapes of K - omega^2 M stay what they are for all values of its parameters: each scales all
/// of K, K_j = s K(p_0), with M_j = 0.
bool keeps_mode_shapes(const fem::ParametricSystem& equations);

/// Whether a beam's motion keeps its mode shapes for all values of the unknowns: then motion that starts in k
/// modes never leaves them, and the reduction to these modes (`modal_truncation`) is no approximation. True
/// of damping ratios, alpha and beta, and of a stiffness that scales all of K, without dashpots, nonlinear
/// forces, or inputs (which reach all modes).
bool keeps_mode_shapes(const fem::ParametricSystem& equations, const MotionDescription& description);

}  // namespace beamid::experiments
