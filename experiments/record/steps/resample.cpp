// Stamps at unequal intervals brought to an even grid, band-limited [oppenheim2010] or by a spline
// [deboor2001].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/interpolation.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// How far every second sample is from the spline through the others, rms relative to the signal's own.
double left_out_error(const Eigen::VectorXd& time, const Eigen::VectorXd& signal) {
  const Index half = signal.size() / 2;
  const auto even = Eigen::seqN(0, half, 2), odd = Eigen::seqN(1, half - 1, 2);
  const CubicSpline spline(time(even), signal(even));
  const double size = std::sqrt((signal.array() - signal.mean()).square().mean());
  const Eigen::VectorXd misses = spline(Eigen::VectorXd(time(odd))) - signal(odd);
  return size > 0 ? std::sqrt(misses.array().square().mean()) / size : 0;
}

/// Of the strongest motion, by the spectrum of an even record [Hz].
double strongest(const Record& record) {
  double frequency = 0, largest = 0;
  for (Index row = 0; row < record.samples.rows(); ++row) {
    const VectorXd signal = record.samples.row(row).transpose();
    if (!signal.array().isFinite().any()) continue;
    const AmplitudeSpectrum one = amplitude_spectrum(bridged_straight(signal), record.interval());
    Index at = 0;
    const double peak = one.amplitude.tail(one.amplitude.size() - 1).maxCoeff(&at);
    const double relative = peak / std::max(one.amplitude.norm(), 1e-300);
    if (relative > largest) largest = relative, frequency = one.frequency_hz[at + 1];
  }
  return frequency;
}

/// How far the interpolation of any channel is off, relative to the signal, and the lowest rate of its nodes
/// [Hz].
struct Quality {
  double error = 0, rate = 0;
};

/// The readings of one channel that are there, parted where two are further apart than `gap`.
struct ResampledPart {
  VectorXd time, signal;
};

std::vector<ResampledPart> parts_of(const VectorXd& time, const VectorXd& signal, double gap) {
  std::vector<ResampledPart> parts;
  std::vector<Index> members;
  const auto end = [&] {
    if (!members.empty()) parts.push_back({time(members), signal(members)});
    members.clear();
  };
  for (Index k = 0; k < time.size(); ++k) {
    if (!std::isfinite(signal[k])) continue;
    if (!members.empty() && time[k] - time[members.back()] > gap) end();
    members.push_back(k);
  }
  end();
  return parts;
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
             "band_limited: exact below 0.4 over the widest interval; spline: cubic"},
            {"largest_gap", 0.0, "",
             "times the median interval, wider ones stay missing; 0: 2.5, or 4 for the spline"}};
  }

  std::string apply(Record& record) const override {
    constexpr Index fewest = 16;
    const Index count = record.size();
    if (count < fewest)
      throw std::invalid_argument(fmt::format("{} samples; expected {} or more", count, fewest));
    const VectorXd steps = record.time.tail(count - 1) - record.time.head(count - 1);
    const double usual = median(steps), gap = largest_gap_ * usual;
    const Eigen::Array<bool, Eigen::Dynamic, 1> within = steps.array() <= gap;
    const double mean = within.select(steps.array(), 0).sum() / static_cast<double>(within.count());
    constexpr double enough = 0.9;  // of the mean rate, which is the higher one where half the record is slow
    const double rate = rate_ > 0 ? rate_ : usual <= mean / enough ? 1 / usual : 1 / mean;
    if (rate * mean < enough)
      throw std::invalid_argument(
          fmt::format("rate_hz is {:g} where samples come at {:g} Hz; expected no less: "
                      "a step = \"decimate\" behind this one keeps aliases out",
                      rate, 1 / mean));
    const double first = record.time[0], length = record.time[count - 1] - first;
    const double points = std::floor(length * rate * (1 + 1e-12)) + 1;
    if (points > most_points)
      throw std::invalid_argument(
          fmt::format("{:.3g} samples from {:.6g} s at {:g} Hz; expected at most {:g}: "
                      "a lower rate_hz, or a window without the gap",
                      points, length, rate, most_points));
    Record even = record;
    even.time = first + Eigen::ArrayXd::LinSpaced(static_cast<Index>(points), 0, points - 1) / rate;
    even.samples.setConstant(record.samples.rows(), even.size(), std::numeric_limits<double>::quiet_NaN());
    even.time_resolution = 0;
    Quality quality{0, 1 / mean};
    for (Index row = 0; row < record.samples.rows(); ++row)
      for (const ResampledPart& part : parts_of(record.time, record.samples.row(row).transpose(), gap))
        put(part, row, even, quality);
    const Index gaps = within.size() - within.count();
    const double frequency = strongest(even), relative = frequency / quality.rate;
    record = std::move(even);
    const std::string how = fmt::format(
        "Resampled at {:.6g} Hz {} through intervals of {:.4g} to {:.4g} s{}; ", rate,
        spline_ ? "by a cubic spline" : "band-limited", steps.minCoeff(),
        within.select(steps.array(), 0).maxCoeff(),
        gaps > 0 ? fmt::format(", what lies in {} longer one{} missing", gaps, gaps == 1 ? "" : "s") : "");
    if (spline_)
      return how + fmt::format(
                       "through every second sample alone it misses the others by up to {:.2g} % of the "
                       "signal (noise included). Through all of them by about a sixteenth of that in a "
                       "smooth signal.",
                       100 * quality.error);
    return how +
           fmt::format(
               "at the strongest frequency, {:.4g} Hz, the kernel errs by {:.1g} of the amplitude (straight "
               "lines by up to {:.2g}), and by less than 1e-4 up to {:.4g} Hz. What lies higher is not kept. "
               "{} samples at either end rest on a linear prediction. It misses the samples "
               "themselves by {:.1g} % of the signal.",
               frequency, BandLimited::kernel_error(std::min(relative, 0.5)),
               linear_interpolation_error(std::min(relative, 0.5)), 0.4 * quality.rate,
               BandLimited::end_nodes, 100 * quality.error);
  }

  void follow(std::vector<FollowedChannel>&, std::complex<double>, double) const override {}
  bool exact() const override { return false; }
  bool takes_any_record() const override { return true; }

 private:
  /// The even samples within the part's time.
  void put(const ResampledPart& part, Index row, Record& even, Quality& quality) const {
    constexpr Index fewest = 4, fewest_for_sinc = 64;
    const Index count = part.time.size();
    if (count < fewest) return;
    const double* const times = even.time.data();
    const double slack = 1e-9 * even.interval();
    const Index from = std::lower_bound(times, times + even.size(), part.time[0] - slack) - times,
                points =
                    std::upper_bound(times, times + even.size(), part.time[count - 1] + slack) - times - from;
    const VectorXd at = even.time.segment(from, points);
    if (spline_ || count < fewest_for_sinc) {
      even.samples.row(row).segment(from, points) = CubicSpline(part.time, part.signal)(at).transpose();
      if (count > 2 * fewest) quality.error = std::max(quality.error, left_out_error(part.time, part.signal));
      return;
    }
    const BandLimited band(part.time, part.signal);
    even.samples.row(row).segment(from, points) = band(at).transpose();
    quality = {std::max(quality.error, band.misfit()), std::min(quality.rate, band.rate())};
  }

  static constexpr double most_points = 1e8;
  double rate_, largest_gap_;
  bool spline_;
};

const bool resample_registered = step_registry().add(
    {"resample",
     "unequal intervals brought to an even grid, band-limited or by a cubic spline, with its error",
     "[oppenheim2010], [bjorck1996], [deboor2001]",
     Resample::options(),
     {},
     [](const filters::Options& o) { return std::make_unique<Resample>(o); }});

}  // namespace
}  // namespace beamid::experiments
