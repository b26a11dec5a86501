// Displacement to velocity, velocity to acceleration.
#include <fmt/format.h>

#include <stdexcept>

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/integration.hpp"

namespace beamid::experiments {
namespace {

Quantity derivative_of(Quantity quantity) {
  return quantity == Quantity::displacement ? Quantity::velocity : Quantity::acceleration;
}

/// (x_(k+1) - x_(k-1)) / (2 dt), at the ends the derivative of the parabola through three samples.
Eigen::VectorXd central_difference(const Eigen::VectorXd& x, double interval) {
  const Eigen::Index n = x.size();
  if (n < 3) throw std::invalid_argument("fewer than 3 samples; expected as many to differentiate");
  Eigen::VectorXd slope(n);
  slope.segment(1, n - 2) = x.tail(n - 2) - x.head(n - 2);
  slope[0] = -3 * x[0] + 4 * x[1] - x[2];
  slope[n - 1] = 3 * x[n - 1] - 4 * x[n - 2] + x[n - 3];
  return slope / (2 * interval);
}

class Differentiate final : public ChannelStep {
 public:
  explicit Differentiate(const filters::Options& options)
      : ChannelStep(options),
        in_frequency_(word_option(options, "in", {"time", "frequency"}) == "frequency"),
        times_(whole_option(options, "times", 1, 2)) {}

  static std::vector<filters::OptionSpec> options() {
    return {{"in", std::string("time"), "", "time: central differences; frequency: multiplication with i w"},
            {"times", 1.0, "", "1, or 2 from displacement to acceleration"},
            channels_option()};
  }

  std::string apply(Record& record) const override {
    const double interval = even_interval(record);
    const std::vector<Eigen::Index> chosen = rows(record);
    std::string text = fmt::format("Differentiated in {}{}: {}.", in_frequency_ ? "frequency" : "time",
                                   times_ == 2 ? ", twice" : "", words(record, chosen));
    for (const Eigen::Index row : chosen) {
      Eigen::VectorXd signal = record.samples.row(row).transpose();
      if (in_frequency_) signal = differentiate_in_frequency(signal, interval, times_);
      for (int n = 0; n < times_; ++n) {
        if (!in_frequency_) signal = central_difference(signal, interval);
        record.channels[row].quantity = derivative_of(record.channels[row].quantity);
      }
      record.samples.row(row) = signal.transpose();
    }
    return text;
  }

  void follow(std::vector<FollowedChannel>& channels, std::complex<double> rate,
              double interval) const override {
    for (FollowedChannel& followed : channels) {
      if (!acts_on(followed.channel)) continue;
      for (int n = 0; n < times_; ++n) {
        followed.factor *= in_frequency_ ? rate : std::sinh(rate * interval) / interval;
        followed.channel.quantity = derivative_of(followed.channel.quantity);
      }
    }
  }

  bool exact() const override { return true; }
  Transient transient(double interval) const override {
    const double samples = in_frequency_ ? 50 : times_;
    return {samples * interval, samples * interval};
  }

 protected:
  bool suits(Quantity quantity) const override {
    return quantity == Quantity::displacement || (times_ == 1 && quantity == Quantity::velocity);
  }

 private:
  bool in_frequency_;
  int times_;
};

const bool differentiate_registered =
    step_registry().add({"differentiate",
                         "displacement to velocity to acceleration, in time or in frequency",
                         "",
                         Differentiate::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Differentiate>(o); }});

}  // namespace
}  // namespace beamid::experiments
