// Harmonic response from point to point.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "fem/modes.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

// Equations of motion in modal coordinates, q = Phi z.

/// z'' + (diag(d) + c) z' + diag(omega^2) z = Gamma f,  y = H Phi z, k modes.
struct ModalBasis {
  Modes modes;
  Eigen::VectorXd square;    ///< omega^2 (k) [1/s2]
  Eigen::VectorXd rate;      ///< d (k) [1/s], zero for structural damping
  Eigen::MatrixXd coupling;  ///< c = Phi^T C Phi (k x k) [1/s], of the dashpots; empty without any
  Eigen::MatrixXd loads;     ///< Gamma = Phi^T E (k x m)
  Eigen::MatrixXd observed;  ///< H Phi (p x k)
};

/// @param count modes; 0: all of a system of at most 200 coordinates, 100 of a larger one.
/// @throws std::invalid_argument when count is not in 0..n or the law is impossible.
ModalBasis modal_basis(const StructuralSystem& system, const DampingLaw& damping, Eigen::Index count);

/// Static deflection under a unit of each input, of the modes left out (n x m): K^-1 (E - M Phi Gamma), what
/// rounding leaves of the modes themselves taken off.
Eigen::MatrixXd residual_deflection(const StructuralSystem& system, const ModalBasis& basis);

/// How a frequency response is computed.
///
/// "direct": at every frequency a complex sparse LU (UMFPACK [davis2004]) of the system with its strain
/// factors,
///
///     [ -D^-1 / (1 + i eta + i omega beta)                  B                   ] [N]   [0]
///     [               B^T               -omega^2 M + i omega (C + alpha M)      ] [q] = [E]
///
/// so that anti-resonances, where modes cancel each other, come out as exactly as resonances. Laws of modal
/// ratios have no sparse matrix: it refuses them.
///
/// "modal": a sum over the lowest modes, with the static deflection of those left out [craig2006]. Dashpots
/// of the model couple the modes, and are kept so.
struct FrequencyResponseMethod {
  std::string name = "direct";
  Eigen::Index modes = 0;      ///< modal: how many; 0: all, 100 where there are more than 200
  bool residual_modes = true;  ///< modal: add the static deflection of the modes left out
};

/// From an input to an output, by their numbers in the system.
struct InputOutput {
  Eigen::Index input = 0, output = 0;
};

/// Displacement at the output per unit of the input, y = H (K - omega^2 M + i omega C)^-1 E (frequencies)
/// [m/N], or [s2] when the input is the acceleration of the base; relative to the base then.
/// @param frequency_hz (frequencies) [Hz], 0 being the static deflection
/// @throws std::invalid_argument when the pair or the method is unknown, a frequency is negative or the law
/// cannot be treated; std::runtime_error, naming the frequency, where an undamped structure resonates.
Eigen::VectorXcd receptance(const StructuralSystem& system, const DampingLaw& damping,
                            const Eigen::VectorXd& frequency_hz, Eigen::Index input, Eigen::Index output,
                            const FrequencyResponseMethod& method = {});

/// The same for many pairs at the price of one: (frequencies x pairs).
Eigen::MatrixXcd receptances(const StructuralSystem& system, const DampingLaw& damping,
                             const Eigen::VectorXd& frequency_hz, const std::vector<InputOutput>& pairs,
                             const FrequencyResponseMethod& method = {});

/// Velocity per input, i omega times the receptance [m/(N s)].
Eigen::VectorXcd mobility(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXcd& receptance);

/// Acceleration per input, -omega^2 times the receptance [1/kg].
Eigen::VectorXcd accelerance(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXcd& receptance);

}  // namespace beamid::fem
