#include "experiments/studies/identify/record_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "experiments/models/estimates.hpp"
#include "experiments/record/axis_label.hpp"
#include "experiments/results/signal_panels.hpp"
#include "experiments/results/thinned_panel.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr const char* reproduced_label = "reproduced with the identified K and C";

Figure reproduction(const Record& record, const RecordIdentification& found, Index row) {
  const Channel& channel = record.channels[static_cast<std::size_t>(row)];
  const double begin = record.time[0], end = record.time[record.size() - 1];
  const double cycles = begin + 6.0 / found.identification.found.frequency_hz();
  const std::string label = axis_label(channel.quantity);
  const VectorXd measured = record.samples.row(row), again = found.reproduced.row(row);
  Panel whole = reproduction_panel("the whole window", record.time, measured,
                                   {{reproduced_label, again, Colour::sky}}, label);
  Figure figure{row == 0 ? "reproduction" : fmt::format("reproduction_{}", row + 1), {}, 0, 1};
  if (cycles < 0.8 * end + 0.2 * begin) {  // else both panels would show the same
    Panel first = whole;
    first.title = "first six cycles";
    first.across(begin, cycles).key(Legend::none);
    figure.panels.push_back(thinned(std::move(first)));
  }
  figure.panels.push_back(thinned(std::move(whole)));
  figure.panels.push_back(
      thinned(residual_panel("measured minus reproduced", record.time, measured - again, label)));
  figure.rows = static_cast<int>(figure.panels.size());
  figure.height = 60 + 250 * figure.rows;
  figure.caption = fmt::format("Record ({}), free decay with the identified K and C, and what it leaves.",
                               channel_title(channel));
  return figure;
}

// Of the first channel: what the model leaves out stands alone, higher modes and coloured noise among it.
std::optional<Figure> spectrum(const Record& record, const RecordIdentification& found) {
  constexpr double multiples = 8;  // of the mode's frequency: a cantilever's second mode is at 6.3
  auto panel = spectrum_panel({{"measured", record.samples.row(0).transpose(), Colour::grey},
                               {reproduced_label, found.reproduced.row(0).transpose(), Colour::blue}},
                              record.interval(), axis_label(record.channels[0].quantity));
  if (!panel) return std::nullopt;
  panel->across(0,
                std::min(panel->x_axis.range->second, multiples * found.identification.found.frequency_hz()));
  Figure figure{"spectrum", {thinned(std::move(*panel))}};
  figure.caption = fmt::format("Amplitude spectra of the record ({}) and of its reproduction.",
                               channel_title(record.channels[0]));
  return figure;
}

// Estimate and 95 % band of one quantity over time, in the last pass, with the axis around its final value.
Panel history(const Record& record, const VectorXd& estimate, const VectorXd& deviation, double modal,
              const char* label, double half_range) {
  const VectorXd half = quantile_95 * deviation;
  Panel panel = Panel{"", {"time [s]"}, {label}}
                    .across(record.time[0], record.time[record.size() - 1])
                    .band("95 %, as in the table", record.time, estimate - half, estimate + half)
                    .line("filter", record.time, estimate, Colour::blue);
  if (std::isfinite(modal)) panel.level("modal analysis", modal);
  // the last pass begins with a band of its own, which is to fill the panel
  const double last = estimate[estimate.size() - 1], shown = std::min(half_range, 1.3 * half.maxCoeff());
  return thinned(std::move(panel.up(last - shown, last + shown)));
}

Figure convergence(const Record& record, const RecordIdentification& found) {
  const filters::FilterRun& run = found.identification.run;
  const Index count = run.means.cols();
  VectorXd frequency(count), frequency_deviation(count), ratio(count), ratio_deviation(count);
  const double frequency_factor = found.frequency_factor(), damping_factor = found.damping_factor();
  for (Index k = 0; k < count; ++k) {
    const Oscillator now{found.identification.found.mass, run.means(0, k), run.means(1, k)};
    frequency[k] = now.frequency_hz();
    frequency_deviation[k] = frequency_factor * 0.5 * frequency[k] * run.deviations(0, k) / now.stiffness;
    ratio[k] = 100.0 * now.damping_ratio();
    ratio_deviation[k] =
        damping_factor * 100.0 * run.deviations(1, k) / (2.0 * std::sqrt(now.stiffness * now.mass));
  }
  const double last_ratio = ratio[count - 1], absent = found.modal_failure.empty() ? 0.0 : std::nan("");
  Figure figure{"convergence", {}, 2, 1};
  figure.panels = {history(record, frequency, frequency_deviation, absent + found.modal.frequency_hz,
                           "frequency [Hz]", 0.02 * frequency[count - 1]),
                   history(record, ratio, ratio_deviation, absent + 100.0 * found.modal.damping_ratio,
                           "damping ratio [%]", std::abs(last_ratio))};
  figure.caption = "Frequency and damping ratio as the filter's last pass goes through the record.";
  return figure;
}

}  // namespace

std::vector<Figure> figures(const Record& record, const RecordIdentification& found) {
  std::vector<Figure> result;
  for (Index row = 0; row < found.reproduced.rows(); ++row)
    result.push_back(reproduction(record, found, row));
  if (found.reproduced.size() > 0)
    if (auto shown = spectrum(record, found)) result.push_back(std::move(*shown));
  if (found.identification.run.means.rows() == 2) result.push_back(convergence(record, found));
  return result;
}

}  // namespace beamid::experiments
