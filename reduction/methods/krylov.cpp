// Moment matching: the reduced receptance agrees with the full one at zero frequency and, if asked, at
// another, in its value and so many derivatives. About s_0, with P = s_0^2 M + s_0 C + K,
//
//     q(s_0 + t) = (P + t (2 s_0 M + C) + t^2 M)^-1 E = sum_j r_j t^j
//     r_0 = P^-1 E,   r_1 = -P^-1 (2 s_0 M + C) r_0,   r_j = -P^-1 ((2 s_0 M + C) r_j-1 + M r_j-2)
//
// the second-order Krylov space [bai2005], here of all forces at once and orthonormal. Without damping the
// vectors about zero are the load-dependent Ritz vectors K^-1 E, K^-1 M K^-1 E, ... [wilson1982]. The
// projection is symmetric: k vectors per force match k coefficients everywhere and 2 k where a force acts.
//
// Rigid-body modes are always kept; the expansion about zero is then one of the elastic rest.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <Eigen/Core>

#include "fem/response/dynamic_stiffness.hpp"
#include "fem/structural_system.hpp"
#include "reduction/constrained_statics.hpp"
#include "reduction/orthonormal_basis.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

// Krylov spaces of systems of second order.

/// Vectors Q (n x r), Q^H M Q = I, that span
///
///     r_0 = b,    r_1 = A b,    r_j = A r_j-1 + B r_j-2
///
/// for every column b of `starts` (n x m): `count` independent ones per column, fewer where there are no
/// more. The recursion itself would soon repeat the strongest motion only. Here pairs (q, p) are kept, p
/// being what would come before q, and both are combined as q is made orthogonal [bai2005]. Where nothing is
/// left of q (every second time when A = 0) its p goes on alone.
///
/// @param a, b  functions that give A q and B q (n) of q (n).
template <class Scalar, class A, class B>
Eigen::MatrixX<Scalar> second_order_arnoldi(const fem::SparseMatrix& mass, const A& a, const B& b,
                                            const Eigen::MatrixX<Scalar>& starts, Eigen::Index count) {
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;
  constexpr double dependent = 1e-11;  // of a vector's own length
  constexpr int tries = 3;             // vectors in a row that may bring nothing
  struct Chain {
    Vector q, p;
    Eigen::Index found = 0;
    int in_vain = 0;
  };
  Matrix basis(mass.rows(), 0), before(mass.rows(), 0);
  const auto norm = [&](const Vector& v) {
    return std::sqrt(std::max(0.0, std::real(v.dot(Vector(mass.template cast<Scalar>() * v)))));
  };
  // Appends what r adds to the basis, s going along with it, and lets the chain continue from there.
  const auto take = [&](Chain& chain, Vector r, Vector s) {
    const double length = norm(r);
    double left = 0.0;
    if (length > 0.0 && basis.cols() < mass.rows()) {
      for (int pass = 0; pass < 3; ++pass) {
        const Vector along = basis.adjoint() * (mass.template cast<Scalar>() * r);
        r -= basis * along;
        s -= before * along;
      }
      left = norm(r);
    }
    const bool is_new = left > dependent * length;
    if (is_new) {
      chain.q = r / left;
      chain.p = s / left;
      basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
      before.conservativeResize(Eigen::NoChange, basis.cols());
      basis.rightCols(1) = chain.q;
      before.rightCols(1) = chain.p;
      ++chain.found;
      chain.in_vain = 0;
    } else {
      chain.q = Vector::Zero(mass.rows());
      chain.p = s;
      ++chain.in_vain;
    }
  };

  std::vector<Chain> chains(static_cast<std::size_t>(starts.cols()));
  for (Eigen::Index i = 0; i < starts.cols(); ++i) take(chains[i], starts.col(i), Vector::Zero(mass.rows()));
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (Chain& chain : chains) {
      if (chain.found >= count || chain.in_vain >= tries) continue;
      goes_on = true;
      take(chain, a(chain.q) + b(chain.p), chain.q);
    }
  }
  return basis;
}

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

MatrixXd loads(const fem::StructuralSystem& system, bool base) {
  std::vector<int> columns = force_inputs(system);
  const int acceleration = base_input(system);
  if (base && acceleration >= 0) columns.push_back(acceleration);
  if (columns.empty())
    throw std::invalid_argument("reduction 'krylov': no force acts on the system; expected an input");
  return MatrixXd(system.inputs)(Eigen::all, columns);
}

MatrixXd about_zero(const fem::StructuralSystem& system, const ElasticStatics& statics, const MatrixXd& load,
                    Index moments) {
  MatrixXd starts(load.rows(), load.cols());
  for (Index i = 0; i < load.cols(); ++i) starts.col(i) = statics.solve(load.col(i));
  const bool damped = system.damping.nonZeros() > 0;
  const auto through = [&](const fem::SparseMatrix& matrix) {
    return [&](const VectorXd& q) -> VectorXd { return -statics.solve(matrix * q); };
  };
  const auto by_damping = through(system.damping);
  return second_order_arnoldi<double>(
      system.mass, [&](const VectorXd& q) -> VectorXd { return damped ? by_damping(q) : VectorXd(0.0 * q); },
      through(system.mass), starts, moments);
}

MatrixXcd about_frequency(const fem::StructuralSystem& system, double frequency_hz, const MatrixXd& load,
                          Index moments) {
  const std::complex<double> s(0.0, 2.0 * std::numbers::pi * frequency_hz);
  fem::DynamicStiffness dynamic(system);
  const auto resonance = [&] {
    return std::invalid_argument("reduction 'krylov': the structure resonates at frequency_hz = " +
                                 std::to_string(frequency_hz) + "; expected one beside it");
  };
  if (!dynamic.factor(1.0, s * s, s)) throw resonance();
  const MatrixXcd starts = dynamic.solve(load.cast<std::complex<double>>()).coordinates;
  if (!starts.allFinite()) throw resonance();
  const auto solve = [&](const VectorXcd& f) -> VectorXcd { return -dynamic.solve(f).coordinates; };
  return second_order_arnoldi<std::complex<double>>(
      system.mass,
      [&](const VectorXcd& q) { return solve(2.0 * s * (system.mass * q) + system.damping * q); },
      [&](const VectorXcd& q) { return solve(system.mass * q); }, starts, moments);
}

class Krylov final : public Reduction {
 public:
  explicit Krylov(const filters::Options& options)
      : moments_(count_option(options, "moments", "krylov", 0)),
        frequency_hz_(options.number("frequency_hz")),
        frequency_moments_(count_option(options, "frequency_moments", "krylov", 1)),
        base_(options.flag("base")) {
    if (frequency_hz_ != 0.0) positive_option(options, "frequency_hz", "krylov");
    if (moments_ == 0 && frequency_hz_ == 0.0)
      throw std::invalid_argument(
          "reduction 'krylov' has neither moments about zero nor a frequency; expected one of them");
  }

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    const MatrixXd load = loads(system, base_);
    const ElasticStatics statics(system);
    OrthonormalBasis basis(system.mass);
    basis.add_all(statics.rigid_modes());
    if (moments_ > 0) basis.add_all(about_zero(system, statics, load, moments_));
    if (frequency_hz_ > 0.0) {
      const MatrixXcd shapes = about_frequency(system, frequency_hz_, load, frequency_moments_);
      for (Index i = 0; i < shapes.cols(); ++i) {
        basis.add(shapes.col(i).real());
        basis.add(shapes.col(i).imag());
      }
    }
    return {basis.columns()};
  }

 private:
  Index moments_;
  double frequency_hz_;
  Index frequency_moments_;
  bool base_;
};

const bool krylov_registered = reduction_registry().add(
    {"krylov",
     "shapes that match the receptance about zero and about a frequency (load-dependent Ritz vectors)",
     "[wilson1982], [bai2005]",
     {{"moments", 2.0, "", "vectors per force about zero"},
      {"frequency_hz", 0.0, "Hz", "another frequency to match at; 0: none"},
      {"frequency_moments", 1.0, "", "vectors per force about that frequency, real and imaginary part"},
      {"base", false, "", "whether the acceleration of the base is matched too"}},
     {contract::static_exact, contract::rigid_exact, contract::grows},
     [](const filters::Options& options) { return std::make_unique<Krylov>(options); }});

}  // namespace

}  // namespace beamid::reduction
