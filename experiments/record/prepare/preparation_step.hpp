// What is done with a record before anything else sees it: steps, found by name like every other method.
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/record.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

// A record as an analysis takes it that knows even stamps and finite samples only.

/// A record at even stamps, without gaps, and what was done for that.
struct AnalysableRecord {
  Record record;
  std::string remark = {};  ///< what was done, a sentence or more; empty: nothing
  double share = 1;         ///< of its samples that were read, not filled in
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> filled = {};  ///< which were not; empty: all were read
  double density = 1;  ///< of its stamps over that of the readings
};

/// Stamps at unequal intervals are brought to an even grid by the step `resample`. Of samples that are
/// missing (NaN), runs of up to 0.6 periods of the channel's strongest line are filled in
/// (missing_samples.hpp); longer ones are not bridged: what lies between two of them, or one and the record's
/// end, is kept, the longest such part, or that which has most of `within`.
/// @param within [s]
/// @throws std::invalid_argument when a channel has no finite sample, or as the step resample.
AnalysableRecord analysable(const Record& record,
                            const std::optional<std::pair<double, double>>& within = {});

/// The record itself where its stamps are even, missing samples and all; else analysable().
AnalysableRecord on_even_stamps(const Record& record);

/// Its record, the remark among the record's own.
Record made_analysable(const Record& record);

/// What a clean decay e^(s t) in a channel has become: factor e^(s t).
struct FollowedChannel {
  Channel channel;
  std::complex<double> factor = 1;
};

/// How long a step's own transients last at the ends of what it leaves [s].
struct Transient {
  double begin = 0, end = 0;
};

/// One step, ready with its options.
class PreparationStep {
 public:
  virtual ~PreparationStep() = default;

  /// Is all there that it needs? Asked once, when all of its options are known.
  /// @throws std::invalid_argument naming the option.
  virtual void check() const {}

  /// Changes the record and tells in one sentence what was done.
  /// @throws std::invalid_argument when the record does not allow it: channels, length, sampling.
  virtual std::string apply(Record& record) const = 0;

  /// Multiplies the factors of the channels it acts on by its own, H(s), and adds the channels it adds.
  /// @param rate s [rad/s], @param interval of the record before the step [s]
  virtual void follow(std::vector<FollowedChannel>& channels, std::complex<double> rate,
                      double interval) const = 0;

  /// Whether H(s) is exact where its transients have decayed: frequency and damping are then untouched there.
  virtual bool exact() const = 0;

  virtual Transient transient(double /*interval*/) const { return {}; }

  /// Whether apply() takes stamps at unequal intervals and missing samples (NaN) as they are.
  virtual bool takes_any_record() const { return false; }

  /// The instant [s] of the event at which it cuts the record; nothing for a step that seeks none.
  virtual std::optional<double> onset(const Record& /*record*/) const { return std::nullopt; }
};

/// PreparationStep::apply(); where the step needs even stamps and finite samples, on what analysable() makes
/// of the record, told first, and with those samples missing again that were.
/// @param within what is wanted of the record [s]
/// @throws std::invalid_argument as the step, or analysable().
std::string apply(const PreparationStep& step, Record& record,
                  const std::optional<std::pair<double, double>>& within = {});

using StepRegistry = filters::Registry<PreparationStep>;
StepRegistry& step_registry();

/// Whether no two stamps are further from one mean interval apart than 5 % and their rounding.
bool evenly_sampled(const Record& record);

/// The sampling interval of a record that a step needs evenly sampled [s].
/// @throws std::invalid_argument where two stamps are not one interval apart, within 5 % and their rounding.
double even_interval(const Record& record);

/// An option that counts something. @throws std::invalid_argument when it is not a whole number from least to
/// most.
int whole_option(const filters::Options& options, const std::string& name, int least, int most);

/// An option that is one of a few words. @throws std::invalid_argument naming them when it is another.
std::string word_option(const filters::Options& options, const std::string& name,
                        const std::vector<std::string>& words);

}  // namespace beamid::experiments
