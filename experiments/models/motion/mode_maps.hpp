// Modes of a beam over the values of its properties, computed once wherever they are needed.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "fem/mode_curves.hpp"

namespace beamid::experiments {

/// The modes at some values of the properties p.
struct ModesThere {
  Eigen::VectorXd square;                       ///< omega^2 (r) [rad2/s2]
  Eigen::MatrixXd square_slopes;                ///< d omega_i^2 / dp_j (r x a)
  Eigen::MatrixXd reading;                      ///< H phi (p x r)
  std::vector<Eigen::MatrixXd> reading_slopes;  ///< by p_j: a of (p x r)
};

/// Maps of the modes (fem/mode_curves.hpp) about the points of a grid in p, each made at the first visit.
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

}  // namespace beamid::experiments
