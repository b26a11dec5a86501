// What filters of several discretisations make of a record at one step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {

/// The discretisation that all others are compared with.
inline constexpr const char* exact_discretisation = "exponential";

/// What one filter makes of the record at one step.
struct SchemeAtStep {
  enum class Verdict {
    exact,        ///< the reference
    harmless,     ///< within the interval of the exact discretisation
    biased,       ///< beyond it, as the closed form says
    unexplained,  ///< not what the closed form says
    invalid       ///< no estimate, or no motion of the scheme is the record's
  };
  std::string discretisation;
  Verdict verdict = Verdict::invalid;
  std::string reason;                  ///< of an invalid one
  std::optional<FoundMode> found;      ///< absent where the filter failed
  std::optional<FoundMode> predicted;  ///< by the closed form, from what the exact one finds at this step
  std::optional<double> mean_nis;      ///< mean normalised square of the innovations

  bool is_valid() const { return verdict != Verdict::invalid && found.has_value(); }
};

const char* to_string(SchemeAtStep::Verdict verdict);

/// The record, every `factor`-th sample behind a low-pass.
struct RecordAtStep {
  int factor = 1;
  double interval = 0.0;  ///< [s]
  Eigen::Index samples = 0;
  double from = 0.0, to = 0.0;      ///< [s]
  std::vector<SchemeAtStep> found;  ///< the exact one first
};

/// Every run of a comparison, the exact discretisation's first, as one step. A damping ratio that the modal
/// analysis contradicts is what is looked for; of the exact one it is invalid.
RecordAtStep record_at_step(const Comparison& comparison, int factor);

}  // namespace beamid::experiments
