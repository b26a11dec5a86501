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
#include <complex>
#include <numbers>

#include "fem/response/dynamic_stiffness.hpp"
#include "reduction/elastic_statics.hpp"
#include "reduction/method_options.hpp"
#include "reduction/orthonormal_basis.hpp"
#include "reduction/places.hpp"
#include "reduction/reduction.hpp"
#include "reduction/second_order_arnoldi.hpp"

namespace beamid::reduction {
namespace {

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
