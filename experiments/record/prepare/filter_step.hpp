// What the three Butterworth steps share: causal or zero-phase, what precedes the record, and the trimming.
#pragma once

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/butterworth.hpp"

namespace beamid::experiments {

/// A causal filter passes a decay e^(s t) as H(e^(s dt)) e^(s t), a zero-phase one as H(e^(s dt)) H(e^(-s
/// dt)) e^(s t): neither changes frequency or damping once its own transient is over. That transient is at
/// the record's start, for a zero-phase filter at both ends.
class FilterStep : public ChannelStep {
 public:
  std::string apply(Record& record) const override;
  bool exact() const override { return true; }
  Transient transient(double interval) const override;

 protected:
  /// @param options holds `zero_phase`, `start`, `trim` and `channels`, as common_options() declares them.
  explicit FilterStep(const filters::Options& options);

  /// `own`, then those that all filters share.
  static std::vector<filters::OptionSpec> with_common_options(std::vector<filters::OptionSpec> own);

  /// @throws std::invalid_argument when a corner was not given.
  static void need(const char* option, double value);

  virtual CascadedFilter filter(double interval) const = 0;
  virtual std::string name() const = 0;  ///< "Butterworth low-pass of order 4 at 10 Hz"

  std::complex<double> factor(std::complex<double> rate, double interval) const override;

 private:
  double settling(double interval) const;  ///< [s]

  bool zero_phase_, trim_;
  FilterStart start_;
};

}  // namespace beamid::experiments
