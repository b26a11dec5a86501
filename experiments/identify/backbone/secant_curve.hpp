// Stiffness and damping of a decay as functions of its amplitude.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/identify/backbone/amplitude_windows.hpp"

namespace beamid::experiments {

/// F(x) = x s(|x|), s = sum_j theta_j B_j(u), u = log(1 + |x| / x0) / log(1 + X / x0), x0 = X / 10: cubic
/// B-splines [deboor2001] on even knots of u (of lower degree below four terms; one term is a straight line).
/// Beyond X s keeps its last value.
class SecantCurve {
 public:
  /// @param range X [m] @param terms q
  /// @throws std::invalid_argument unless X > 0 and q >= 1.
  SecantCurve(double range, Eigen::Index terms);

  double range() const { return range_; }
  Eigen::Index terms() const { return terms_; }

  /// B_j at |x| (q), and dB_j/d|x| where asked for.
  Eigen::VectorXd shape(double x, Eigen::VectorXd* slope = nullptr) const;

  /// The few that are not zero there: values and slopes of B_first, B_first+1, ... (count).
  struct Local {
    Eigen::Index first = 0, count = 1;
    std::array<double, 4> value{}, slope{};
  };
  Local local(double x) const;

 private:
  double range_, bend_, whole_;
  Eigen::Index terms_, degree_;
  std::vector<Eigen::Matrix4d> pieces_;  ///< by interval of u: row m, the polynomial of B_(interval + m)
};

/// Rows a (q) of what is linear in theta at the amplitude A, a . theta:
///
/// the stiffness of the describing function [gelb1968] of an elastic spring, which a motion x = A sin t sees,
///
///     K_eq = 4 / (pi A) int_0^(pi/2) F(A sin t) sin t dt
Eigen::VectorXd elastic_stiffness(const SecantCurve& curve, double amplitude);

/// (less than 2 % off the square of its exact frequency: periodic_motion());
///
/// of Masing's loop [masing1926], whose branches are the backbone at twice the scale: the part in phase
/// is that of their mean, F((A + x) / 2) - F((A - x) / 2);
Eigen::VectorXd masing_stiffness(const SecantCurve& curve, double amplitude);

/// what that loop dissipates, 8 int_0^A F dx - 4 A F(A) [J].
Eigen::VectorXd masing_energy(const SecantCurve& curve, double amplitude);

/// what a viscous damping c(|x|) = shape . theta dissipates as a constant one:
/// 4 / pi int_0^(pi/2) c(A sin t) cos^2 t dt.
Eigen::VectorXd equivalent_damping(const SecantCurve& curve, double amplitude);

/// The exact motion of the amplitude A on an elastic spring without damping [kovacic2011], which is no linear
/// function of theta: T = 4 int_0^A dx / sqrt(2 (V(A) - V(x)) / M), V = int F dx.
struct PeriodicMotion {
  double stiffness = 0;       ///< M omega^2; NaN where V does not rise
  double first_harmonic = 1;  ///< of the displacement, over A
};
PeriodicMotion periodic_motion(const SecantCurve& curve, const Eigen::VectorXd& theta, double amplitude);

// Whether the damping of a decay depends on its amplitude, and as what does.

/// C(A) of the windows as c0 + c1 g(A), by least squares weighed with the windows' deviations.
struct DampingTrend {
  enum class Kind {
    none,  ///< constant: what is left of c0 alone is less than six times chance, or C changes by under 30 %
    friction,  ///< g = 1 / A: a force F of constant size dissipates 4 F A a cycle, as C = 4 F / (pi omega A)
    drag,      ///< g = A: c2 |x'| x' dissipates 8/3 c2 omega^2 A^3, as C = 8 c2 omega A / (3 pi)
    other      ///< neither takes three quarters of what c0 leaves
  };
  Kind kind = Kind::none;
  double constant = 0;     ///< c0 [N s/m]; of none and other the weighed mean
  double coefficient = 0;  ///< F [N] or c2 [N s2/m2]
  double deviation = 0;    ///< of the coefficient, with what the law leaves of C for its noise
};

DampingTrend damping_trend(const std::vector<AmplitudeWindow>& windows);

/// A sentence; empty where the damping is constant.
std::string damping_trend_text(const DampingTrend& trend, const std::vector<AmplitudeWindow>& windows);

}  // namespace beamid::experiments
