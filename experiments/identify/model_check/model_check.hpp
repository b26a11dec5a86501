// The finite-element prediction against identified modes, and what would explain the difference.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/model_check/candidates.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/record/record.hpp"
#include "fem/damping.hpp"

namespace beamid::experiments {

/// A mode that records of a structure have shown. Deviations are NaN where unknown.
struct ObservedMode {
  double frequency_hz = 0, frequency_deviation_hz = 0;
  double damping_ratio = 0, damping_ratio_deviation = 0;
  Eigen::VectorXcd shape = {};            ///< (p) at the channels; empty: unknown
  std::vector<std::string> records = {};  ///< that show it, by name; empty: unknown
};

/// A structure as it is described and as it was found to be.
struct CheckedStructure {
  std::string name;
  fem::Beam beam;
  int elements = 40;
  fem::DampingLaw damping = {};
  std::vector<ObservedMode> modes;
  std::vector<Channel> channels = {};      ///< p, of the shapes
  std::vector<std::string> warnings = {};  ///< of its records
};

/// A predicted mode and the identified one that belongs to it.
struct CheckedMode {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::size_t structure = 0;
  int number = 0;  ///< of the prediction, from 1
  double predicted_hz = 0, predicted_damping_ratio = unknown;
  ObservedMode identified;
  double assurance = unknown;  ///< MAC; NaN with fewer than two channels
  bool far = false;            ///< beyond 30 %, taken for this mode since nothing else is near

  double difference() const;  ///< ln(identified / predicted)
};

/// What one change, or two together, make of the differences.
struct Explanation {
  enum class Verdict {
    explains,      ///< chi^2 within its 95 % and all changes plausible
    implausible,   ///< chi^2 within its 95 %, a change beyond what is plausible
    undetermined,  ///< an interval wider than what is plausible: the data cannot tell
    leaves_much    ///< chi^2 above its 95 %
  };
  std::vector<std::size_t> candidates;  ///< one or two
  Eigen::VectorXd change, deviation;    ///< x and its standard deviation
  std::vector<bool> at_limit;           ///< held by what is possible
  double correlation = 0;               ///< of the two
  Eigen::VectorXd left;                 ///< ln(identified / changed prediction) (n)
  double chi_square = 0;
  Eigen::Index freedom = 0;  ///< n less the changes
  bool plausible = true;     ///< all changes, within their intervals
  Verdict verdict = Verdict::leaves_much;

  double lower_95(std::size_t i) const { return change[i] - 1.96 * deviation[i]; }
  double upper_95(std::size_t i) const { return change[i] + 1.96 * deviation[i]; }
};
const char* to_string(Explanation::Verdict verdict);

struct ModelCheckSettings {
  double model_error = 0.005;           ///< standard deviation of a predicted frequency, relative
  std::vector<std::string> candidates;  ///< by name; empty: all that the beams can have
};

/// What all but one structure agree on.
struct Outlier {
  std::size_t structure = 0;
  std::optional<Explanation> others;  ///< of the others; absent: they are as described
};

struct ModelCheck {
  std::vector<CheckedStructure> structures;
  ModelCheckSettings settings;
  std::vector<CheckedMode> modes;                            ///< n
  std::vector<std::pair<std::size_t, ObservedMode>> strays;  ///< structure and mode without a counterpart
  std::vector<Candidate> candidates;                         ///< c
  Eigen::MatrixXd effect;                        ///< (n x c) d ln f / dx times the candidate's scale
  double chi_square = 0;                         ///< of the beams as described
  bool right = false;                            ///< within its 95 %
  std::vector<Explanation> single, pairs;        ///< best first
  std::vector<std::string> contradictions = {};  ///< sentences: records that others contradict
  std::optional<Outlier> outlier = {};           ///< the structure without which the others are explained
};

/// Least squares on r_i = ln(f_i / f_i(x)) with variance (d_i / f_i)^2 + model_error^2, exact frequencies at
/// every x (docs/theory/model_check.md). An identified mode belongs to the nearest predicted one within
/// 30 %, with a shape of MAC 0.5 at least where there are shapes. Where nothing lies so near the lowest
/// predicted mode, the nearest within a factor of 2 is taken for it, half as far from it as from any other:
/// a mass may be mistaken by a factor. Of several structures the few that are so far off are named and left
/// out.
/// @throws std::invalid_argument when no mode has a counterpart, or a candidate is unknown or none of these
/// beams'.
ModelCheck check_model(std::vector<CheckedStructure> structures, const ModelCheckSettings& settings);

}  // namespace beamid::experiments
