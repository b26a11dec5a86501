// Methods that take one mode of a free decay at a time, at the peaks of its spectrum.
#pragma once

#include <string>

#include "experiments/modal/isolated_mode.hpp"
#include "experiments/modal/modal_method.hpp"

namespace beamid::experiments {

/// What a method makes of one isolated mode. Deviations [rad/s] are NaN where unknown.
struct ModeAnswer {
  std::complex<double> rate;  ///< [rad/s]
  double frequency_deviation = Pole::unknown, damping_rate_deviation = Pole::unknown;
  std::string remark = {};  ///< a sentence; empty: none
};

/// search() finds the peaks (spectral_peaks), isolates each mode in the channel where it is largest and asks
/// estimate(); a mode that cannot be isolated, does not decay or is less certain than its own size is
/// refused, with the reason.
class ModeByModeMethod : public ModalMethod {
 public:
  PoleSearch search(const Eigen::MatrixXd& outputs, double interval, int largest_order) const final;

 private:
  /// @throws std::invalid_argument when the mode is too short for the method.
  virtual ModeAnswer estimate(const IsolatedMode& mode) const = 0;
};

}  // namespace beamid::experiments
