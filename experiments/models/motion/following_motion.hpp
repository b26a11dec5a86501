// The whole mesh in its own lowest modes, which follow the unknowns:
//
//     z_i'' + (alpha + beta omega_i^2 + 2 xi_i omega_i) z_i' + omega_i^2 z_i = phi_i^T E f,    q = sum_i
//     phi_i z_i
//
// with omega_i(p) and phi_i(p) those of the mesh at the unknowns' current values.
//
// A free decay that starts in some modes of a beam stays in them; a force moves the others as well, so that
// they should lie above what it excites. Held in the mesh's own coordinates the
// start would lie in the modes of the guess: as soon as an unknown moves, it excites all modes of the mesh,
// and acceleration shows the highest of them most. A filter would take their absence from the record for
// knowledge of the unknowns.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "experiments/models/motion/second_order_motion.hpp"
#include "fem/modes.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments {

// Modes of a beam over the values of its properties, computed once wherever they are needed.

/// The modes at some values of the properties p.
struct ModesThere {
  Eigen::VectorXd square;                       ///< omega^2 (r) [rad2/s2]
  Eigen::MatrixXd square_slopes;                ///< d omega_i^2 / dp_j (r x a)
  Eigen::MatrixXd reading;                      ///< H phi (p x r)
  std::vector<Eigen::MatrixXd> reading_slopes;  ///< by p_j: a of (p x r)
};

/// Maps of the modes (fem/modes.hpp) about the points of a grid in p, each made at the first visit.
class ModeMaps {
 public:
  using Equations = std::function<fem::ParametricSystem(const Eigen::VectorXd& values)>;

  /// @param spacing of the grid (a); @param reading of the modes at p_0, for their signs (p x r)
  ModeMaps(Equations equations, Eigen::VectorXd reference, Eigen::VectorXd spacing, Eigen::MatrixXd reading);

  /// @param change p - p_0 (a)
  /// @throws std::runtime_error where the beam does not oscillate, or has no such values.
  ModesThere at(const Eigen::VectorXd& change);

 private:
  using Cell = std::vector<long>;

  Equations equations_;
  Eigen::VectorXd reference_, spacing_;
  Eigen::MatrixXd reading_;
  std::mutex mutex_;
  std::map<Cell, std::vector<fem::ModeCurve>> maps_;

  const std::vector<fem::ModeCurve>& map_of(const Cell& cell);
};

class ModeMaps;

class FollowingMotion final : public SecondOrderMotion {
 public:
  /// The beam's equations where its properties have these values (a). Their outputs are what the observations
  /// read (p), then the deflections that the measured forces work on, E^T (m).
  using Equations = std::function<fem::ParametricSystem(const Eigen::VectorXd& values)>;

  /// @param description its damped modes say by `number` which mode they are
  /// @param frequencies omega at the guess (r) [rad/s]
  /// @param reading those outputs of the modes at the guess, phi^T M phi = 1 (p + m x r)
  /// @param scale q = sum_i scale_i phi_i z_i (r)
  FollowingMotion(Equations equations, MotionDescription description, Eigen::VectorXd frequencies,
                  const Eigen::MatrixXd& reading, Eigen::VectorXd scale);

  /// Modes are computed where the properties are multiples of a hundredth of their guesses, and followed to
  /// the second order from there to the nearest values asked for: right to 1e-8, the same whatever was asked
  /// before.
  void evaluate(const Eigen::VectorXd& state, SecondOrderForm& form,
                std::vector<SecondOrderForm>* slopes) const override;
  bool decoupled() const override { return true; }
  Eigen::VectorXd frequencies() const override { return frequencies_; }

 private:
  std::shared_ptr<ModeMaps> maps_;  // shared by copies: it only remembers
  Eigen::VectorXd frequencies_, scale_;

  std::shared_ptr<const SecondOrderMotion> copy() const override {
    return std::make_shared<FollowingMotion>(*this);
  }
};

}  // namespace beamid::experiments
