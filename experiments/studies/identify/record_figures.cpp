#include "experiments/studies/identify/record_figures.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

Figure reproduction(const Record& record, const RecordIdentification& found) {
  const double begin = record.time[0], end = record.time[record.size() - 1];
  const double cycles = begin + 6.0 / found.identification.found.frequency_hz();
  const bool long_record = cycles < 0.8 * end + 0.2 * begin;  // else both panels would show the same
  Figure figure{"reproduction", {}, long_record ? 2 : 1, 1};
  for (const bool whole : {false, true}) {
    if (!whole && !long_record) continue;
    Panel panel{whole ? "the whole window" : "first six cycles",
                {"time [s]"},
                {std::string(to_string(record.channels[0].quantity)) + " [" +
                 si_unit(record.channels[0].quantity) + "]"},
                {}};
    panel.curves = {
        {"measured", record.time, record.samples.row(0).transpose(), CurveStyle::line, {}, {}, Colour::grey},
        {"reproduced with the identified K and C",
         record.time,
         found.reproduced.row(0).transpose(),
         CurveStyle::dashed,
         {},
         {},
         Colour::blue}};
    panel.x_axis.range = {begin, whole ? end : std::min(cycles, end)};
    panel.legend = whole ? Legend::below : Legend::none;
    figure.panels.push_back(panel);
  }
  return figure;
}

// Of the first channel: what the model leaves out stands alone, higher modes and coloured noise among it.
Figure spectrum(const Record& record, const RecordIdentification& found) {
  constexpr double multiples = 8;  // of the mode's frequency: a cantilever's second mode is at 6.3
  constexpr double decades = 6;    // below the peak
  const Eigen::VectorXd readings = bridged_straight(record.samples.row(0).transpose());
  const AmplitudeSpectrum measured = amplitude_spectrum(readings, record.interval()),
                          model = amplitude_spectrum(found.reproduced.row(0).transpose(), record.interval());
  const double peak = measured.amplitude.maxCoeff(), floor = std::pow(10.0, -decades) * peak;
  const Channel& channel = record.channels[0];
  Panel panel{
      "",
      {"frequency [Hz]"},
      {std::string("amplitude of ") + to_string(channel.quantity) + " [" + si_unit(channel.quantity) + "]",
       true},
      {}};
  panel.curves = {{"measured",
                   measured.frequency_hz,
                   measured.amplitude.cwiseMax(floor),
                   CurveStyle::line,
                   {},
                   {},
                   Colour::grey},
                  {"reproduced with the identified K and C",
                   model.frequency_hz,
                   model.amplitude.cwiseMax(floor),
                   CurveStyle::line,
                   {},
                   {},
                   Colour::blue}};
  const double last = measured.frequency_hz[measured.frequency_hz.size() - 1];
  panel.x_axis.range = {0.0, std::min(last, multiples * found.identification.found.frequency_hz())};
  panel.legend = Legend::below;
  return {"spectrum", {panel}};
}

// Estimate and 95 % band of one quantity over time, in the last pass, with the axis around its final value.
Panel history(const Record& record, const VectorXd& estimate, const VectorXd& deviation, double modal,
              const char* label, double half_range) {
  Panel panel{"", {"time [s]"}, {label}, {}};
  panel.curves = {{"95 %, as in the table",
                   record.time,
                   {},
                   CurveStyle::band,
                   estimate - 1.96 * deviation,
                   estimate + 1.96 * deviation},
                  {"filter", record.time, estimate, CurveStyle::line, {}, {}, Colour::blue}};
  if (std::isfinite(modal))
    panel.curves.push_back({"modal analysis",
                            Eigen::Vector2d(record.time[0], record.time[record.size() - 1]),
                            Eigen::Vector2d(modal, modal),
                            CurveStyle::dashed,
                            {},
                            {},
                            Colour::black});
  // the last pass begins with a band of its own, which is to fill the panel
  const double last = estimate[estimate.size() - 1],
               half = std::min(half_range, 1.3 * 1.96 * deviation.maxCoeff());
  panel.y_axis.range = {last - half, last + half};
  panel.x_axis.range = {record.time[0], record.time[record.size() - 1]};
  return panel;
}

Figure convergence(const Record& record, const RecordIdentification& found) {
  const auto& beliefs = found.identification.run.filtered;
  const auto count = static_cast<Index>(beliefs.size());
  VectorXd frequency(count), frequency_deviation(count), ratio(count), ratio_deviation(count);
  const double frequency_factor = found.frequency_factor(), damping_factor = found.damping_factor();
  for (Index k = 0; k < count; ++k) {
    const Oscillator now{found.identification.found.mass, beliefs[k].mean[2], beliefs[k].mean[3]};
    frequency[k] = now.frequency_hz();
    frequency_deviation[k] =
        frequency_factor * 0.5 * frequency[k] * std::sqrt(beliefs[k].covariance(2, 2)) / now.stiffness;
    ratio[k] = 100.0 * now.damping_ratio();
    ratio_deviation[k] = damping_factor * 100.0 * std::sqrt(beliefs[k].covariance(3, 3)) /
                         (2.0 * std::sqrt(now.stiffness * now.mass));
  }
  const double last_ratio = ratio[count - 1], absent = found.modal_failure.empty() ? 0.0 : std::nan("");
  Figure figure{"convergence", {}, 2, 1};
  figure.panels = {history(record, frequency, frequency_deviation, absent + found.modal.frequency_hz,
                           "frequency [Hz]", 0.02 * frequency[count - 1]),
                   history(record, ratio, ratio_deviation, absent + 100.0 * found.modal.damping_ratio,
                           "damping ratio [%]", std::abs(last_ratio))};
  figure.panels.front().legend = Legend::none;
  return figure;
}

}  // namespace

std::vector<Figure> figures(const Record& record, const RecordIdentification& found) {
  std::vector<Figure> result;
  if (found.reproduced.size() > 0) {
    result.push_back(reproduction(record, found));
    result.push_back(spectrum(record, found));
  }
  if (!found.identification.run.filtered.empty()) result.push_back(convergence(record, found));
  return result;
}

}  // namespace beamid::experiments
