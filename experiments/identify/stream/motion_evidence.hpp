// Whether a stream's readings are motion, or only noise about a constant.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "filters/filter.hpp"

namespace beamid::experiments {

/// The filter's predictions against those of a structure at rest, reading after reading:
///
///     ln Lambda = sum_k ln p(y_k | y_0 .. y_k-1, filter) - ln p(y_k | y_0 .. y_k-1, rest),
///
/// rest being a constant of every output, unknown at first, and noise. Of a structure at rest Lambda is a
/// martingale of mean 1 whatever the filter predicts, so that it ever exceeds 1 / q with probability q at
/// most [ville1939]. A filter that has learned a frequency from noise predicts no better than rest does,
/// however small the deviations that it reports.
class MotionEvidence {
 public:
  static constexpr double unlikely = 1e-15;  ///< q, as of InnovationWatch

  /// @param output y_k (p); NaN: not measured
  /// @param deviations of the noise (p)
  /// @param mean_square of the filter's innovations over what they should be; above 1 the noise is larger
  /// than stated, for both
  void take_in(const Eigen::VectorXd& output, const Eigen::VectorXd& deviations,
               const filters::Correction& correction, double mean_square);
  /// Motion has stood out of the noise since the start.
  bool seen() const { return seen_; }
  void begin_anew() { *this = {}; }

  nlohmann::ordered_json save() const;
  /// @throws nlohmann::json::exception, std::invalid_argument when it is not what save() gave
  void resume(const nlohmann::json& saved, Eigen::Index outputs);

 private:
  Eigen::VectorXd mean_, variance_;  // of every output at rest (p); variance 0: not read yet
  double evidence_ = 0.0;            // ln Lambda
  bool seen_ = false;
};

}  // namespace beamid::experiments
