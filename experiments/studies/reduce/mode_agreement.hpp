// How well the modes of one model are those of another [allemang2003], [lieven1988].
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/damping.hpp"

namespace beamid::experiments {

/// MAC weighted with the mass, (phi_i^T M psi_j)^2 / (phi_i^T M phi_i  psi_j^T M psi_j) (k x l), of shapes
/// phi (n x k) and psi (n x l).
///
/// Modes are orthogonal in M: it is 0 for different modes of one model, and its rows and columns sum to at
/// most 1. The plain MAC of deflections has neither, and changes with the spacing of the nodes.
Eigen::MatrixXd mac(const Eigen::MatrixXd& phi, const Eigen::MatrixXd& psi, const fem::SparseMatrix& mass);

/// The plain MAC, without a weight, of deflections (p x k) and (p x l) at any points: (k x l).
Eigen::MatrixXd mac(const Eigen::MatrixXd& phi, const Eigen::MatrixXd& psi);

/// For each row of a mass-weighted MAC the column above 1/2, of which there is one at most, and no other row
/// has it: the mode that stands for this one. -1: none does.
std::vector<Eigen::Index> partners(const Eigen::MatrixXd& mac);

/// Co-ordinate MAC of k pairs of modes at each of p points,
///
///     (sum_i |phi_pi psi_pi|)^2 / (sum_i phi_pi^2  sum_i psi_pi^2)      (p)
///
/// @param phi, psi deflections (p x k), column i of one standing for column i of the other, each scaled to
/// unit modal mass. NaN where no mode of one of them moves the point, and everywhere for less than two pairs:
/// one pair alone gives 1 whatever its shapes are.
Eigen::VectorXd comac(const Eigen::MatrixXd& phi, const Eigen::MatrixXd& psi);

/// The point where modes agree least; NaN and -1 where there is no number, no point where all is 1 to 1e-9.
struct LowestComac {
  double value = 0.0;
  Eigen::Index point = -1;
};
LowestComac lowest_comac(const Eigen::VectorXd& comac);

}  // namespace beamid::experiments
