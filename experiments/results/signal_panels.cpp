#include "experiments/results/signal_panels.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {

std::optional<Panel> spectrum_panel(const std::vector<DrawnSignal>& signals, double interval,
                                    const std::string& label, double decades) {
  Panel panel{"", {"frequency [Hz]"}, {"amplitude of " + label, true}};
  double highest = 0, last = 0;
  for (const DrawnSignal& signal : signals) {
    const AmplitudeSpectrum spectrum = amplitude_spectrum(bridged_straight(signal.samples), interval);
    const Eigen::Index lines = spectrum.frequency_hz.size() - 1;  // without 0: the mean is taken off
    if (lines < 1) continue;
    highest = std::max(highest, spectrum.amplitude.tail(lines).maxCoeff());
    last = std::max(last, spectrum.frequency_hz[lines]);
    panel.line(signal.label, spectrum.frequency_hz.tail(lines), spectrum.amplitude.tail(lines),
               signal.colour);
  }
  if (!(highest > 0)) return std::nullopt;
  if (signals.size() == 1) panel.legend = Legend::none;
  return panel.across(0, last).up(std::pow(10.0, -decades) * highest, 2 * highest);
}

Panel reproduction_panel(const std::string& title, const Eigen::VectorXd& time,
                         const Eigen::VectorXd& measured, const std::vector<DrawnSignal>& reproduced,
                         const std::string& label) {
  Panel panel{title, {"time [s]"}, {label}};
  for (const DrawnSignal& one : reproduced) panel.line(one.label, time, one.samples, one.colour);
  return panel.thin("measured", time, measured, Colour::black).across(time[0], time[time.size() - 1]);
}

namespace {

double size_of(const Eigen::VectorXd& values) {
  return values.size() > 0 ? values.array().isFinite().select(values.array().abs(), 0.0).maxCoeff() : 0.0;
}

/// The next of ..., 1, 2, 5, 10, ... that is not below a size; 1 of zero.
double round_size(double most) {
  if (!(most > 0)) return 1;
  const double decade = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {1.0, 2.0, 5.0})
    if (most <= step * decade) return step * decade;
  return 10 * decade;
}

}  // namespace

Panel residual_panel(const std::string& title, const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                     const std::string& label, double largest) {
  const double most = round_size(largest > 0.0 ? largest : size_of(residual));
  Panel panel = Panel{title, {"time [s]"}, {"residual, " + label}}
                    .thin("", time, residual, Colour::black)
                    .across(time[0], time[time.size() - 1])
                    .up(-most, most)
                    .key(Legend::none);
  panel.y_axis.tick = most;
  return panel;
}

}  // namespace beamid::experiments
