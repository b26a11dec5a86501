// Steps that act on some channels and leave time as it is.
#pragma once

#include <functional>

#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/butterworth.hpp"

namespace beamid::experiments {

class ChannelStep : public PreparationStep {
 public:
  /// Multiplies the factor of every channel it acts on by factor().
  void follow(std::vector<FollowedChannel>& channels, std::complex<double> rate,
              double interval) const override;

 protected:
  /// @param options holds `channels`: names or quantities between commas; empty: all that can be taken.
  explicit ChannelStep(const filters::Options& options);

  /// `channels` itself, as every such step declares it.
  static filters::OptionSpec channels_option();

  virtual std::complex<double> factor(std::complex<double> /*rate*/, double /*interval*/) const { return 1; }

  /// Whether the step can act on a quantity.
  virtual bool suits(Quantity /*quantity*/) const { return true; }

  bool acts_on(const Channel& channel) const;

  /// The rows of a record's samples that the step acts on, one at least.
  /// @throws std::invalid_argument when a name is no channel's or there is nothing to act on.
  std::vector<Eigen::Index> rows(const Record& record) const;

  /// "acceleration", "acceleration tip, velocity": the channels in words.
  static std::string words(const Record& record, const std::vector<Eigen::Index>& rows);

 private:
  std::vector<std::string> names_;
};

// What the three Butterworth steps share: causal or zero-phase, what precedes the record, and the trimming.

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
