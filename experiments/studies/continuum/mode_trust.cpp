#include "experiments/studies/continuum/mode_trust.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

VectorXd discretisation_error(const fem::Modes& modes, const fem::Modes& halved, const fem::Modes& quartered,
                              double order) {
  constexpr double slowest = 0.75;
  VectorXd error = VectorXd::Constant(modes.size(), std::numeric_limits<double>::quiet_NaN());
  for (Index i = modes.rigid; i < modes.size(); ++i) {
    const double first = modes.angular_frequency[i] / halved.angular_frequency[i] - 1.0,
                 second = halved.angular_frequency[i] / quartered.angular_frequency[i] - 1.0;
    const double left = first == 0.0 ? 0.0 : std::abs(second / first);
    error[i] = std::max(std::abs(first) / (1.0 - std::clamp(left, std::pow(0.5, order), slowest)),
                        std::abs(first + second));
  }
  return error;
}

VectorXd discretisation_error(const fem::Modes& fine, const fem::Modes& coarse, double ratio, double order) {
  VectorXd error = VectorXd::Constant(fine.size(), std::numeric_limits<double>::quiet_NaN());
  for (Index i = fine.rigid; i < std::min(fine.size(), coarse.size()); ++i)
    error[i] = std::abs(coarse.angular_frequency[i] / fine.angular_frequency[i] - 1.0) /
               (std::pow(ratio, order) - 1.0);
  return error;
}

std::vector<std::string> accuracy_notes(const fem::Modes& modes) {
  constexpr double enough_digits = 8.0, enough_agreement = 1e-6;
  std::vector<std::string> notes;
  for (Index i = modes.rigid; i < modes.size(); ++i) {
    if (const double digits = modes.digits(i); digits < enough_digits)
      notes.push_back(fmt::format(
          "Mode {}: the frequency of the solver and the Rayleigh quotient of its shape, {:.12g} and {:.12g} "
          "Hz, agree to {:.0f} digits only; trust no more of them.",
          i + 1, modes.frequency_hz()[i], modes.rayleigh_angular_frequency[i] / (2.0 * std::numbers::pi),
          std::floor(digits)));
    if (modes.residual[i] > enough_agreement)
      notes.push_back(
          fmt::format("Mode {}: a residual of {:.1e}; its shape is not accurate.", i + 1, modes.residual[i]));
  }
  return notes;
}

double rounded(double value, double scale) {
  return std::abs(value) < 1e-12 * scale ? 0.0 : value;
}

}  // namespace beamid::experiments
