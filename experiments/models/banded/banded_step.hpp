// One step of the scheme `pade` on sparse equations of motion, and its tangent.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "experiments/models/banded/banded_equations.hpp"
#include "experiments/models/banded/step_factor.hpp"
#include "experiments/models/motion/parametric_motion.hpp"

namespace beamid::experiments::banded {

// Damping of single modes in a sparse system: a term of low rank.

/// With S_b, K + lambda C + lambda^2 M without them, k damped modes and G = [g_1 ... g_k] (n x k) the inverse
/// is [woodbury1950]
///
///     (S_b + lambda G c G^T)^-1 b = y - Z (I + lambda c G^T Z)^-1 lambda c G^T y,
///     y = S_b^-1 b,   Z = S_b^-1 G,
///
/// c being diagonal. In this form modes may be without damping.
class ModalCorrection {
 public:
  explicit ModalCorrection(Eigen::Index size) : size_(size), zeros_(size), lanes_(size), block_(size) {}

  /// Z and the k x k system; b (n), a right side, goes through the factor beside G and comes out
  /// solved, correction included.
  void factor(const StepFactor& factored, const std::vector<ModeDamping>& modes, const Complex& lambda,
              Complex* b);

  /// y (n), of the same modes, corrected in place; likewise four columns.
  void operator()(const std::vector<ModeDamping>& modes, Complex* y) const;
  void operator()(const std::vector<ModeDamping>& modes, ComplexLanes* y) const;

 private:
  template <class Real>
  void correct(const std::vector<ModeDamping>& modes, ComplexOf<Real>* b) const;
  /// G^T b
  template <class Real>
  std::vector<ComplexOf<Real>> overlaps_of(const std::vector<ModeDamping>& modes,
                                           const ComplexOf<Real>* b) const;
  template <class Real>
  void take_response_off(const ComplexOf<Real>* seen, ComplexOf<Real>* b) const;  ///< `seen`: G^T y

  Eigen::Index size_;
  std::vector<std::vector<Complex>> responses_;  // Z (k of n)
  std::vector<Complex> coupling_;                // (I + lambda c G^T Z)^-1 lambda c (k x k)
  std::vector<double> zeros_;
  std::vector<Lanes> lanes_;
  std::vector<ComplexLanes> block_;
};

/// g^T x of vectors (n).
Complex inner(const double* g, const Complex* x, Eigen::Index size);

/// E f of a step, as BandedStep takes it.
struct StepForce {
  Eigen::VectorXd re, im;  ///< (n)
};

/// R(z) = (12 + 6z + z^2) / (12 - 6z + z^2) has the poles c = 3 + i sqrt 3 and its conjugate, and partial
/// fractions turn x+ = R(A dt) x + (what forces add) into one complex system: with lambda = c / dt and the
/// forces' mean and slope over the step (StepInput),
///
///     (K + lambda C + lambda^2 M) d = K q - E f - lambda M q',    f = mean - (c / 12) slope
///
///     q+ = q + 4 sqrt3 Im d,    q'+ = q' + (12 / dt) (Re d + sqrt3 Im d).
///
/// K meets q through the strain factors, and what elimination does to the assembled K is small beside
/// lambda^2 M (docs/theory/continuum_filter.md); where it is not small enough, one residual of d takes it
/// back. Derivatives are those of these equations: along a change of q, q' and the unknowns,
///
///     S d' = K q_' - lambda M q'_' + sum_u (dF/du - dS/du d) u',    S = K + lambda C + lambda^2 M,  F: right
///     side.
///
/// Damping of single modes, sum_i c_i g_i g_i^T, is of low rank (banded_step.hpp).
class BandedStep {
 public:
  /// @param interval dt [s]
  BandedStep(const BandedEquations& equations, double interval);

  /// S at the values that the equations hold now. @throws std::runtime_error when it is singular.
  void factor(const BandedEquations& equations);

  /// The motion q, q' (n each) one step on, into other places than it is. The rest of this class then speaks
  /// of this step.
  void advance(const BandedEquations& equations, const double* q, const double* rate, const StepForce& force,
               double* next, double* next_rate);

  /// dF/du - dS/du d (n) for one unknown: the rows it reaches and, of the damping of single modes, multiples
  /// of their momenta g_i, rows - sum_i along_i g_i.
  struct Forcing {
    std::vector<Complex> rows;  ///< n, zero outside [first, last)
    Eigen::Index first = 0, last = 0;
    std::vector<Complex> along;  ///< of each damped mode
  };
  /// @param force_slope E_j f
  void by_property(const BandedEquations& equations, Eigen::Index j, const double* q, const double* rate,
                   const StepForce& force_slope, Forcing& forcing) const;
  void by_mass_damping(const BandedEquations& equations, Forcing& forcing) const;
  void by_stiffness_damping(const BandedEquations& equations, Forcing& forcing) const;
  /// xi of the damped modes named. May be added to.
  void by_ratio(const BandedEquations& equations, const std::vector<Eigen::Index>& modes,
                Forcing& forcing) const;

  /// Directions (q, q' in the first 2n rows; r columns) one step on, in place.
  /// @param parts u' of each forcing in each direction (u x r)
  void move(const BandedEquations& equations, const std::vector<Forcing>& forcings,
            const Eigen::MatrixXd& parts, Eigen::MatrixXd& directions);

  /// Whether S is kept as a band.
  bool is_band() const { return factor_.is_band(); }
  /// The largest entry that eliminating S met over the largest of S.
  double growth() const { return growth_; }
  /// Whether growth() is to be found by each factor(): it takes as long again.
  void watch_growth(bool watch) { watches_growth_ = watch; }

 private:
  template <class Real>
  void solve(const BandedEquations& equations, ComplexOf<Real>* b) const;
  void refine(const BandedEquations& equations);
  void add_forcings(const BandedEquations& equations, const std::vector<Forcing>& forcings,
                    const Eigen::MatrixXd& parts, Eigen::Index first, int count);

  Eigen::Index size_;
  double interval_;
  bool refines_;
  Complex lambda_;
  StepFactor factor_;
  std::vector<Complex> entries_;  // S
  ModalCorrection correction_;
  std::vector<Complex> modes_seen_;        // g_i^T d of the damped modes
  std::vector<Complex> solution_, right_;  // d (n), and the right side it belongs to
  std::vector<double> work_, work_rate_, zeros_, nowhere_;
  mutable std::vector<Complex> point_;
  std::vector<Lanes> lanes_, lanes_rate_, lanes_work_;
  bool is_new_ = false;  // the factor: the correction is not yet of it
  std::vector<ComplexLanes> block_;
  bool watches_growth_ = false;
  double growth_ = 0.0;
};

}  // namespace beamid::experiments::banded
