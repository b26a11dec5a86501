// Stamps at unequal intervals brought to an even grid by a cubic spline [deboor2001].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/preparation/preparation_step.hpp"
#include "experiments/signal/cubic_spline.hpp"

namespace beamid::experiments {
namespace {

/// How far every second sample is from the spline through the others, rms relative to the signal's own.
double left_out_error(const Eigen::VectorXd& time, const Eigen::VectorXd& signal) {
  const Eigen::Index half = signal.size() / 2;
  const auto even = Eigen::seqN(0, half, 2), odd = Eigen::seqN(1, half - 1, 2);
  const CubicSpline spline(time(even), signal(even));
  const double size = std::sqrt((signal.array() - signal.mean()).square().mean());
  const Eigen::VectorXd misses = spline(Eigen::VectorXd(time(odd))) - signal(odd);
  return size > 0 ? std::sqrt(misses.array().square().mean()) / size : 0;
}

class Resample final : public PreparationStep {
 public:
  explicit Resample(const filters::Options& options)
      : rate_(options.number("rate_hz")), largest_gap_(options.number("largest_gap")) {}

  static std::vector<filters::OptionSpec> options() {
    return {
        {"rate_hz", 0.0, "Hz", "of the even grid; 0: one sample per median interval"},
        {"largest_gap", 4.0, "", "times the median interval; a spline knows nothing of what lies in more"}};
  }

  std::string apply(Record& record) const override {
    constexpr Eigen::Index fewest = 16;
    const Eigen::Index count = record.size();
    if (count < fewest)
      throw std::invalid_argument(fmt::format("{} samples; expected {} or more", count, fewest));
    const Eigen::VectorXd steps = record.time.tail(count - 1) - record.time.head(count - 1);
    Eigen::VectorXd sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2], rate = rate_ > 0 ? rate_ : 1 / median;
    Eigen::Index widest = 0;
    const double gap = steps.maxCoeff(&widest);
    if (gap > largest_gap_ * median)
      throw std::invalid_argument(fmt::format(
          "a gap of {:.4g} s at {:.6g} s, {:.3g} times the median interval; expected at most {:g} times", gap,
          record.time[widest], gap / median, largest_gap_));
    if (rate * record.interval() < 0.9)
      throw std::invalid_argument(
          fmt::format("rate_hz is {:g} where samples come at {:g} Hz; expected no less: "
                      "a step = \"decimate\" behind this one keeps aliases out",
                      rate, 1 / record.interval()));
    const double first = record.time[0], length = record.time[count - 1] - first;
    const auto points = static_cast<Eigen::Index>(std::floor(length * rate * (1 + 1e-12))) + 1;
    Record even = record;
    even.time = first + Eigen::ArrayXd::LinSpaced(points, 0, static_cast<double>(points - 1)) / rate;
    even.samples.resize(record.samples.rows(), points);
    even.time_resolution = 0;
    double error = 0;
    for (Eigen::Index row = 0; row < record.samples.rows(); ++row) {
      const Eigen::VectorXd signal = record.samples.row(row).transpose();
      even.samples.row(row) = CubicSpline(record.time, signal)(even.time).transpose();
      error = std::max(error, left_out_error(record.time, signal));
    }
    record = std::move(even);
    return fmt::format(
        "Resampled at {:.6g} Hz by a cubic spline through intervals of {:.4g} to {:.4g} s; through every "
        "second "
        "sample alone it misses the others by up to {:.2g} % of the signal (noise included), through all of "
        "them by about a sixteenth of that in a smooth signal.",
        rate, steps.minCoeff(), gap, 100 * error);
  }

  void follow(std::vector<FollowedChannel>&, std::complex<double>, double) const override {}
  bool exact() const override { return false; }

 private:
  double rate_, largest_gap_;
};

const bool registered =
    step_registry().add({"resample",
                         "unequal intervals brought to an even grid by a cubic spline, its error told",
                         "[deboor2001]",
                         Resample::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Resample>(o); }});

}  // namespace
}  // namespace beamid::experiments
