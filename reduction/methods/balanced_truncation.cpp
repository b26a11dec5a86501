// Second-order balanced truncation of the symmetric transfer from forces to deflections at the same points,
//
//     G(s) = H (s^2 M + s C + K)^-1 H^T.
//
// Position-velocity balancing [reis2008] asks for shapes in which the position gramian P_p (what the forces
// reach, at any velocity [meyer1996]) and the velocity gramian Q_v (what the deflections see of an initial
// velocity) are equal and diagonal. Here both are one: an impulse at a point is an initial velocity. Hence
// Psi = Phi, the projection is Galerkin's, and the reduced system is symmetric and stable; with other pairs
// of gramians [chahlaoui2006] it would be neither.
//
// In modes, U^T M U = I, each damped by the ratio xi, with b_i = H u_i and d_i = 2 xi omega_i, impulse
// responses h_i(t) b_i give
//
//     P_ij = b_i^T b_j int_0^oo h_i h_j dt
//          = b_i^T b_j (d_i + d_j) / ((d_i + d_j) (d_i omega_j^2 + d_j omega_i^2) + (omega_i^2 -
//          omega_j^2)^2)
//
// which is diagonal when xi is small [gawronski1998], 1 / (4 xi omega^3). Phi = U V, V the eigenvectors of P;
// its eigenvalues are the position-velocity singular values. Rigid-body modes, which no gramian bounds, are
// kept before all others.
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "fem/modes.hpp"
#include "reduction/constrained_statics.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

const std::string balanced_truncation_owner = "reduction 'balanced_truncation'";
constexpr Index most_modes = 100;  // that a gramian is formed of, where there are more than twice as many

MatrixXd gramian(const MatrixXd& seen, const VectorXd& frequency, double ratio) {
  const Index k = frequency.size();
  MatrixXd result = seen.transpose() * seen;
  for (Index i = 0; i < k; ++i)
    for (Index j = 0; j < k; ++j) {
      const double a = frequency[i], b = frequency[j], rates = 2.0 * ratio * (a + b);
      const double gap = (a - b) * (a + b);
      result(i, j) *= rates / (rates * 2.0 * ratio * a * b * (a + b) + gap * gap);
    }
  return result;
}

class BalancedTruncation final : public Reduction {
 public:
  explicit BalancedTruncation(const filters::Options& options)
      : modes_(count_option(options, "modes", "balanced_truncation", 1)),
        ratio_(positive_option(options, "damping_ratio", "balanced_truncation")) {
    if (!(ratio_ < 1.0))
      throw std::invalid_argument("option 'damping_ratio' of " + balanced_truncation_owner + " is " +
                                  std::to_string(ratio_) + "; expected one below 1");
  }

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    const Index n = system.size();
    require_at_most(modes_, n, "modes", "balanced_truncation");
    const std::vector<int> points = master_coordinates(system, {}, balanced_truncation_owner);
    const fem::Modes modes = fem::modes(system, n <= 2 * most_modes ? n : std::max(most_modes, modes_));
    const Index rigid = modes.rigid, flexible = modes.size() - rigid;
    if (modes_ <= rigid) return {modes.shape.leftCols(modes_)};

    const MatrixXd seen = modes.shape(points, Eigen::all).rightCols(flexible);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> balanced(
        gramian(seen, modes.angular_frequency.tail(flexible), ratio_));
    const MatrixXd shapes = modes.shape.rightCols(flexible) * balanced.eigenvectors().rowwise().reverse();
    MatrixXd kept(n, modes_);
    kept << modes.shape.leftCols(rigid), shapes.leftCols(modes_ - rigid);
    return {kept, balanced.eigenvalues().reverse().cwiseMax(0.0), "position-velocity singular value [m s/N]"};
  }

 private:
  Index modes_;
  double ratio_;
};

const bool balanced_truncation_registered = reduction_registry().add(
    {"balanced_truncation",
     "shapes that forces at the outputs reach, and the outputs see, the most",
     "[reis2008], [meyer1996]",
     {{"modes", 1.0, "", "number of shapes kept, rigid-body modes among them"},
      {"damping_ratio", 0.005, "", "of all modes, for the gramian"}},
     {contract::rigid_exact, contract::grows},
     [](const filters::Options& options) { return std::make_unique<BalancedTruncation>(options); }});

}  // namespace
}  // namespace beamid::reduction
