// Steps that act on some channels and leave time as it is.
#pragma once

#include <functional>

#include "experiments/record/prepare/preparation_step.hpp"

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

}  // namespace beamid::experiments
