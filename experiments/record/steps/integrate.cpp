// Acceleration to velocity, velocity to displacement.
#include <fmt/format.h>

#include <stdexcept>

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/integration.hpp"

namespace beamid::experiments {
namespace {

Quantity integral_of(Quantity quantity) {
  return quantity == Quantity::acceleration ? Quantity::velocity : Quantity::displacement;
}

class Integrate final : public ChannelStep {
 public:
  explicit Integrate(const filters::Options& options)
      : ChannelStep(options),
        in_frequency_(word_option(options, "in", {"time", "frequency"}) == "frequency"),
        from_rest_(word_option(options, "start", {"mean", "rest"}) == "rest"),
        keep_(options.flag("keep")),
        times_(whole_option(options, "times", 1, 2)),
        corner_(options.number("corner_hz")) {}

  static std::vector<filters::OptionSpec> options() {
    return {{"in", std::string("time"), "", "time: trapezoidal rule; frequency: division by i w"},
            {"times", 1.0, "", "1, or 2 from acceleration to displacement"},
            {"corner_hz", 0.0, "Hz", "in frequency, where it must be given: what lies below is omitted"},
            {"start", std::string("mean"), "",
             "in time: the constant that makes the integral's mean zero, or starts it from rest"},
            {"keep", false, "", "keep what was integrated, and what lies between, beside the integral"},
            channels_option()};
  }

  void check() const override {
    if (in_frequency_ && !(corner_ > 0))
      throw std::invalid_argument(
          "corner_hz is missing; expected a corner above 0 Hz to integrate in frequency");
    if (!in_frequency_ && corner_ != 0)
      throw std::invalid_argument("corner_hz without use in time; expected in = \"frequency\" beside it");
  }

  std::string apply(Record& record) const override {
    const double interval = even_interval(record);
    const std::vector<Eigen::Index> chosen = rows(record);
    std::string text =
        "Integrated in " +
        (in_frequency_ ? fmt::format("frequency above {:g} Hz", corner_) : std::string("time")) +
        (times_ == 2 ? ", twice: " : ": ") + words(record, chosen);
    if (!in_frequency_)
      text += fmt::format("; a mean of up to {:.3g} that remained in it drifts",
                          record.samples(chosen, Eigen::all).rowwise().mean().cwiseAbs().maxCoeff());
    for (const Eigen::Index row : chosen) {
      const Eigen::VectorXd signal = record.samples.row(row).transpose();
      for (int n = keep_ ? 1 : times_; n <= times_; ++n) {
        const Eigen::Index place = keep_ ? record.samples.rows() : row;
        if (keep_) {
          record.samples.conservativeResize(place + 1, Eigen::NoChange);
          record.channels.push_back(record.channels[n == 1 ? row : place - 1]);
        }
        for (int k = keep_ ? n : 1; k <= n; ++k)
          record.channels[place].quantity = integral_of(record.channels[place].quantity);
        record.samples.row(place) = integral(signal, interval, n).transpose();
      }
    }
    return text + ".";
  }

  void follow(std::vector<FollowedChannel>& channels, std::complex<double> rate,
              double interval) const override {
    const std::complex<double> once = factor(rate, interval);
    const std::size_t count = channels.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (!acts_on(channels[i].channel)) continue;
      FollowedChannel now = channels[i];
      for (int n = 1; n <= times_; ++n) {
        now.channel.quantity = integral_of(now.channel.quantity);
        now.factor *= once;
        if (keep_) channels.push_back(now);
      }
      if (!keep_) channels[i] = now;
    }
  }

  /// Twice in time leaves a ramp, which no settling takes away.
  bool exact() const override { return in_frequency_ || times_ == 1; }
  Transient transient(double) const override {
    return in_frequency_ ? Transient{3 / corner_, 3 / corner_} : Transient{};
  }

 protected:
  bool suits(Quantity quantity) const override {
    return quantity == Quantity::acceleration || (times_ == 1 && quantity == Quantity::velocity);
  }

  std::complex<double> factor(std::complex<double> rate, double interval) const override {
    if (!in_frequency_) return trapezoidal_response(rate, interval);
    return std::pow(above_corner(rate.imag() / (2 * std::acos(-1.0)), corner_), 1.0 / times_) / rate;
  }

 private:
  Eigen::VectorXd integral(Eigen::VectorXd signal, double interval, int times) const {
    if (in_frequency_) return integrate_in_frequency(signal, interval, times, corner_);
    for (int n = 0; n < times; ++n) {
      signal = cumulative_trapezoid(signal, interval, from_rest_ ? 0.5 * interval * signal[0] : 0).eval();
      if (!from_rest_) signal.array() -= signal.mean();
    }
    return signal;
  }

  bool in_frequency_, from_rest_, keep_;
  int times_;
  double corner_;
};

const bool integrate_registered =
    step_registry().add({"integrate",
                         "acceleration to velocity to displacement, in time or in frequency",
                         "",
                         Integrate::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Integrate>(o); }});

}  // namespace
}  // namespace beamid::experiments
