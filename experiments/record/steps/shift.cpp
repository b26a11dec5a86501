// Channels whose clock is known to be late or early, on the clock of the others.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/interpolation.hpp"

namespace beamid::experiments {
namespace {

class Shift final : public ChannelStep {
 public:
  explicit Shift(const filters::Options& options) : ChannelStep(options), late_(options.number("late_s")) {}

  static std::vector<filters::OptionSpec> options() {
    return {{"late_s", 0.0, "s", "how late the channels' stamps are; below 0: early"}, channels_option()};
  }

  void check() const override {
    if (late_ == 0.0 || !std::isfinite(late_))
      throw std::invalid_argument(
          fmt::format("late_s is {:g}; expected the time by which the stamps are late", late_));
  }

  std::string apply(Record& record) const override {
    const std::vector<Eigen::Index> moved = rows(record);
    for (const Eigen::Index row : moved)
      record.samples.row(row) = shifted(record.time, record.samples.row(row).transpose(), late_).transpose();
    return fmt::format(
        "Earlier by {:g} s, band-limited between the samples: {}. Ends that need what lies beyond "
        "the record are missing.",
        late_, words(record, moved));
  }

  bool exact() const override { return true; }

 private:
  std::complex<double> factor(std::complex<double> rate, double) const override {
    return std::exp(rate * late_);
  }

  double late_;
};

const bool shift_registered =
    step_registry().add({"shift",
                         "earlier by the time that its stamps are late, where a clock is known to differ",
                         "",
                         Shift::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Shift>(o); }});

}  // namespace
}  // namespace beamid::experiments
