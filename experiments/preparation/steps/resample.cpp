// Stamps at unequal intervals brought to an even grid, band-limited [oppenheim2010] or by a spline
// [deboor2001].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/preparation/preparation_step.hpp"
#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/signal/band_limited.hpp"
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

/// Of the strongest motion, by the spectrum of the samples as if they were even [Hz].
double strongest(const Record& record) {
  double frequency = 0, largest = 0;
  for (Eigen::Index row = 0; row < record.samples.rows(); ++row) {
    const AmplitudeSpectrum one = amplitude_spectrum(record.samples.row(row).transpose(), record.interval());
    Eigen::Index at = 0;
    const double peak = one.amplitude.tail(one.amplitude.size() - 1).maxCoeff(&at);
    const double relative = peak / std::max(one.amplitude.norm(), 1e-300);
    if (relative > largest) largest = relative, frequency = one.frequency_hz[at + 1];
  }
  return frequency;
}

class Resample final : public PreparationStep {
 public:
  explicit Resample(const filters::Options& options)
      : rate_(options.number("rate_hz")),
        largest_gap_(options.number("largest_gap")),
        spline_(options.text("method") == "spline") {
    if (const std::string word = options.text("method"); word != "spline" && word != "band_limited")
      throw std::invalid_argument("method is '" + word + "'; expected band_limited or spline");
    if (largest_gap_ == 0) largest_gap_ = spline_ ? 4 : 2.5;
  }

  static std::vector<filters::OptionSpec> options() {
    return {{"rate_hz", 0.0, "Hz", "of the even grid; 0: one sample per median interval"},
            {"method", std::string("band_limited"), "",
             "band_limited: exact below 0.4 of the rate; spline: cubic"},
            {"largest_gap", 0.0, "", "times the median interval; 0: 2.5, or 4 for the spline"}};
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
      if (spline_) {
        even.samples.row(row) = CubicSpline(record.time, signal)(even.time).transpose();
        error = std::max(error, left_out_error(record.time, signal));
      } else {
        const BandLimited band(record.time, signal);
        even.samples.row(row) = band(even.time).transpose();
        error = std::max(error, band.misfit());
      }
    }
    const double frequency = strongest(record), relative = frequency * record.interval();
    record = std::move(even);
    const std::string how =
        fmt::format("Resampled at {:.6g} Hz {} through intervals of {:.4g} to {:.4g} s; ", rate,
                    spline_ ? "by a cubic spline" : "band-limited", steps.minCoeff(), gap);
    if (spline_)
      return how + fmt::format(
                       "through every second sample alone it misses the others by up to {:.2g} % of the "
                       "signal (noise included), through all of them by about a sixteenth of that in a "
                       "smooth signal.",
                       100 * error);
    return how +
           fmt::format(
               "at the strongest frequency, {:.4g} Hz, which is {:.3g} of the mean rate, the kernel errs "
               "by {:.1g} of the amplitude (straight lines by {:.2g}), and by less than 1e-4 up to 0.4 of "
               "the rate; {} samples at either end rest on a linear prediction. It misses the samples "
               "themselves by {:.1g} % of the signal.",
               frequency, relative, BandLimited::kernel_error(std::min(relative, 0.5)),
               linear_interpolation_error(relative), BandLimited::end_nodes, 100 * error);
  }

  void follow(std::vector<FollowedChannel>&, std::complex<double>, double) const override {}
  bool exact() const override { return false; }

 private:
  double rate_, largest_gap_;
  bool spline_;
};

const bool registered = step_registry().add(
    {"resample",
     "unequal intervals brought to an even grid, band-limited or by a cubic spline, its error told",
     "[oppenheim2010], [bjorck1996], [deboor2001]",
     Resample::options(),
     {},
     [](const filters::Options& o) { return std::make_unique<Resample>(o); }});

}  // namespace
}  // namespace beamid::experiments
