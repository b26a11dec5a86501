// The lines of a record, those of its first moments included.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace beamid::experiments {

struct RecordLine {
  double frequency_hz = 0;
  double resolution_hz = 0;  ///< two resolutions of the window that shows it
  double share = 0;          ///< of the strongest line of that window
};

/// Lines of a free decay (samples p x N, channels of about the same size) by rising frequency: of the whole
/// record and of its first quarter, sixteenth, ... down to 128 samples. A mode that has died out after a
/// tenth of the record is averaged away in the whole, and clear in the beginning. A line has a fiftieth of
/// the strongest one's amplitude in its window and lies 6 times above the noise around it
/// (spectral_peaks.hpp).
std::vector<RecordLine> record_lines(const Eigen::MatrixXd& samples, double interval);

/// "22.8 and 65.74 Hz"; of more than 6 the first and how many there are.
std::string frequencies_text(const std::vector<double>& frequencies_hz);

}  // namespace beamid::experiments
