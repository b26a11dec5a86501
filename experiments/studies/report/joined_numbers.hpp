// The numbers of a results.json by name, as they are compared with those of another.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace beamid::experiments {

/// A number of a results.json. Lists are entered by the names of their entries ("rayleigh, ekf, exponential",
/// "run1.csv"), modes by their frequency, never by their place.
struct JoinedNumber {
  std::string name;  ///< "rayleigh, ekf: bending stiffness [N m2]"
  double value = 0;
  double deviation = std::nan("");  ///< standard deviation; NaN: a plain number
};

/// Names for modes that are the same in several results.
class ModeNames {
 public:
  /// "mode at 3.456 Hz": that of the first frequency seen within 5 % of this one.
  std::string name(double frequency_hz);

 private:
  std::vector<double> known_;
};

/// All but configuration, diagnostics and histories, in the file's order.
std::vector<JoinedNumber> joined_numbers(const nlohmann::ordered_json& results, ModeNames& modes);

}  // namespace beamid::experiments
