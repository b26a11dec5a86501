// The record cut so that it starts some time after a hit or a release.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/onsets.hpp"

namespace beamid::experiments {
namespace {

class Event final : public PreparationStep {
 public:
  explicit Event(const filters::Options& options)
      : channel_(options.text("channel")),
        number_(whole_option(options, "number", 1, 1000000)),
        delay_(options.number("delay_s")),
        duration_(options.number("duration_s")) {
    settings_.threshold = options.number("threshold");
    settings_.smallest = options.number("smallest");
    settings_.apart = options.number("apart_s");
    settings_.quiet_duration = options.number("quiet_s");
    if (!(duration_ >= 0 && settings_.quiet_duration >= 0))
      throw std::invalid_argument("duration_s and quiet_s; expected no negative number");
    if (!(settings_.threshold > 0 && settings_.smallest > 0 && settings_.apart > 0))
      throw std::invalid_argument("threshold, smallest and apart_s; expected positive numbers");
  }

  static std::vector<filters::OptionSpec> options() {
    const OnsetSettings usual;
    return {{"number", 1.0, "", "which event, from 1"},
            {"delay_s", 0.0, "s", "of the first sample kept, after the event; may be negative"},
            {"duration_s", 0.0, "s", "that is kept; 0: to the record's end"},
            {"channel", std::string(), "",
             "name or quantity of the channel that shows the events; empty: a force, else the first"},
            {"threshold", usual.threshold, "", "times the noise before the first event"},
            {"smallest", usual.smallest, "", "relative to the largest deviation: less is no event"},
            {"apart_s", usual.apart, "s", "between events; at least half a period of the vibration"},
            {"quiet_s", 0.0, "s", "at the record's start that hold noise only; 0: found"}};
  }

  std::string apply(Record& record) const override {
    const Eigen::Index row = sought(record);
    const Onsets found = onsets(record, row);
    const double at = record.time[found.samples[number_ - 1]], from = at + delay_;
    const double last = record.time[record.size() - 1];
    record = record.window(from, duration_ > 0 ? from + duration_ : last);
    const std::string unit = si_unit(record.channels[row].quantity);
    return fmt::format(
        "Cut to {:.4f} to {:.4f} s, {:g} s after event {} of {} at {:.4f} s in {} (noise before the first: "
        "{:.3g} {}).",
        record.time[0], record.time[record.size() - 1], delay_, number_, found.samples.size(), at,
        to_string(record.channels[row].quantity), found.noise, unit);
  }

  std::optional<double> onset(const Record& record) const override {
    return record.time[onsets(record, sought(record)).samples[number_ - 1]];
  }

  void follow(std::vector<FollowedChannel>&, std::complex<double>, double) const override {}
  bool exact() const override { return true; }

 private:
  Eigen::Index sought(const Record& record) const {
    for (std::size_t i = 0; i < record.channels.size(); ++i) {
      const Channel& channel = record.channels[i];
      if (channel_.empty() ? channel.quantity == Quantity::force
                           : channel_ == channel.name || channel_ == to_string(channel.quantity))
        return static_cast<Eigen::Index>(i);
    }
    if (!channel_.empty()) throw std::invalid_argument("no channel '" + channel_ + "' in the record");
    return 0;
  }

  Onsets onsets(const Record& record, Eigen::Index row) const {
    Onsets found = find_onsets(record.samples.row(row).transpose(), even_interval(record), settings_);
    if (found.samples.size() < static_cast<std::size_t>(number_))
      throw std::invalid_argument(
          fmt::format("{} event{} in {}, above {:g} times the noise of {:.3g} {} and {:g} of the largest "
                      "deviation; expected {} or more, after a quiet start of 8 samples or more",
                      found.samples.size(), found.samples.size() == 1 ? "" : "s",
                      to_string(record.channels[row].quantity), settings_.threshold, found.noise,
                      si_unit(record.channels[row].quantity), settings_.smallest, number_));
    return found;
  }

  std::string channel_;
  int number_;
  double delay_, duration_;
  OnsetSettings settings_;
};

const bool event_registered =
    step_registry().add({"event",
                         "the record cut to start a stated time after a hit or a release",
                         "",
                         Event::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Event>(o); }});

}  // namespace
}  // namespace beamid::experiments
