#include "experiments/identify/recorded_frequency.hpp"

#include <stdexcept>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/forced_mode.hpp"

namespace beamid::experiments {

RecordedFrequency recorded_frequency(const Eigen::VectorXd& output, const Eigen::MatrixXd& inputs,
                                     double interval, double expected_hz) {
  try {
    if (inputs.rows() > 0) return {forced_mode(output, inputs, interval, expected_hz).frequency_hz, ""};
    ModalAnalysisSettings settings;
    settings.expected_frequency_hz = expected_hz;
    return {dominant_mode(output, interval, settings).frequency_hz, ""};
  } catch (const std::exception& error) {
    return {{}, error.what()};
  }
}

}  // namespace beamid::experiments
