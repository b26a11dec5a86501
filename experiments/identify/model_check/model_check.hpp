// The finite-element prediction against identified modes, and what would explain the difference.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/identify/model_check/candidates.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/record/record.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {

/// A mode that records of a structure have shown. Deviations are NaN where unknown.
struct ObservedMode {
  double frequency_hz = 0, frequency_deviation_hz = 0;
  double damping_ratio = 0, damping_ratio_deviation = 0;
  Eigen::VectorXcd shape = {};            ///< (p) at the channels; empty: unknown
  std::vector<std::string> records = {};  ///< that show it, by name; empty: unknown
  double shape_deviation = 0;             ///< of each component, in the shape's scale; 0: unknown
  std::optional<int> number = {};         ///< where it is known, from 1
};

/// A structure as it is described and as it was found to be.
struct CheckedStructure {
  std::string name;
  fem::Structure structure;
  int elements = 40;  ///< of a beam, or of each member of a frame
  fem::DampingLaw damping;
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
  /// Whether the changed structures' modes are paired with it by shape, as update does; else by number.
  bool paired_by_shape() const;
};

/// What one change, or two together, make of the differences.
struct Explanation {
  enum class Verdict {
    explains,      ///< chi^2 within its 95 % and all changes plausible
    implausible,   ///< chi^2 within its 95 %, a change beyond what is plausible
    undetermined,  ///< not determined by these modes: wider than what is plausible
    leaves_much    ///< chi^2 above its 95 %
  };
  std::vector<std::size_t> candidates = {};  ///< one or two
  Eigen::VectorXd change, deviation;         ///< x and its standard deviation
  Eigen::VectorXd lower, upper;              ///< 95 %
  std::vector<bool> at_limit = {};           ///< on its bound: held by what is possible
  std::vector<bool> determined = {};
  std::vector<double> others = {};  ///< of one change: further values that fit as well
  double correlation = 0;           ///< of the two
  Eigen::VectorXd left;             ///< ln(identified / changed prediction) (n)
  double chi_square = 0;
  Eigen::Index freedom = 0;             ///< numbers measured less the changes that are determined
  std::size_t starts = 0, reached = 0;  ///< searches, and those that ended here
  bool plausible = true;                ///< all changes, within their intervals
  Verdict verdict = Verdict::leaves_much;

  double lower_95(std::size_t i) const { return lower[static_cast<Eigen::Index>(i)]; }
  double upper_95(std::size_t i) const { return upper[static_cast<Eigen::Index>(i)]; }
};
const char* to_string(Explanation::Verdict verdict);

struct ModelCheckSettings {
  double model_error = 0.005;           ///< standard deviation of a predicted frequency, relative
  std::vector<std::string> candidates;  ///< by name; empty: all that the structures can have
  double shape_error = 0.03;            ///< of a predicted shape's component, a part of the largest
};

/// What all but one structure agree on.
struct Outlier {
  std::size_t structure = 0;
  std::optional<Explanation> others;  ///< of the others; absent: they are as described
};

struct ModelCheck {
  std::vector<CheckedStructure> structures;
  ModelCheckSettings settings;
  std::vector<CheckedMode> modes = {};                            ///< n, by structure and number
  std::vector<std::pair<std::size_t, ObservedMode>> strays = {};  ///< structure, mode without a counterpart
  std::vector<Candidate> candidates = {};                         ///< c
  Eigen::MatrixXd effect = {};           ///< (n x c) d ln f / dx times the largest plausible change
  Eigen::MatrixXd alike = {};            ///< (c x c) cosines between what candidates do to the residual
  double chi_square = 0;                 ///< of the structures as described
  Eigen::Index numbers = 0;              ///< independent ones in it
  bool right = false;                    ///< within its 95 %
  std::vector<Explanation> single = {};  ///< best first
  std::vector<Explanation> pairs = {};   ///< likewise
  std::size_t possible_pairs = 0;        ///< of which those that come nearest at first order were fitted
  std::vector<std::string> contradictions = {};  ///< sentences: records that others contradict
  std::optional<Outlier> outlier = {};           ///< the structure without which the others are explained
};

/// update of one change at a time, and of two (docs/theory/model_check.md): its residual, its pairing, its
/// search, its words, on the changed structures assembled anew. An identified mode belongs to the predicted
/// one within 30 % that makes MAC - |ln(f / f')| largest in sum, with a MAC of 0.5 at least where there are
/// shapes. Where nothing lies so near the lowest predicted mode, the nearest within a factor of 2 is taken
/// for it, half as far from it as from any other: a mass may be mistaken by a factor. Of several structures
/// the few that are so far off are named and left out. Pairs are tried where no change alone explains, or
/// where there are few of them.
/// @throws std::invalid_argument when no mode has a counterpart, or a candidate is unknown or none of these
/// structures'.
ModelCheck check_model(std::vector<CheckedStructure> structures, const ModelCheckSettings& settings);

// What several records of one beam show, as one.

/// The modes of all records, merged (mode_objections.hpp), each with the records that show it; the larger of
/// the two deviations counts.
std::vector<ObservedMode> observed_modes(const std::vector<RecordModes>& records);

}  // namespace beamid::experiments
