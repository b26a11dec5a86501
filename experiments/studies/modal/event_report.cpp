
#include "experiments/studies/modal/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/modal/channel_fault.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/results/figure.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

struct Event {
  std::string name, channel;
  double peak = 0.0, base_peak = 0.0;  // [m/s2]
  std::optional<BaseResponse> response;
  std::string reason;  // why there is none
  ChannelFault fault;
  double interval = 0.0;  // [s]
};

constexpr double much_left = 30.0, much_damped = 0.3;  // [%], [-]

// What is wrong with the two channels, or what makes the fit uncertain.
std::string fault_sentence(const Event& event) {
  const ChannelFault& fault = event.fault;
  const std::string then = fmt::format(
      "has a residual of {:.3g} % of the motion instead of {}: f1 {:.4g} Hz, damping ratio {:.3g} %",
      fault.instead.left_percent,
      std::isfinite(fault.left_percent) ? fmt::format("{:.3g} %", fault.left_percent) : "more than half",
      fault.instead.frequency_hz, 100.0 * fault.instead.damping_ratio);
  const std::string wrong = event.response ? " What the table states of it is wrong." : "";
  switch (fault.kind) {
    case ChannelFault::Kind::reversed:
      return fmt::format("The sign of one channel is turned: so changed, one mode {}.{}", then, wrong);
    case ChannelFault::Kind::late:
      return fmt::format("The response was recorded {} samples ({:.3g} s) too {}: moved back, one mode {}.{}",
                         std::abs(fault.samples), std::abs(fault.samples) * event.interval,
                         fault.samples > 0 ? "late" : "early", then, wrong);
    case ChannelFault::Kind::exchanged:
      return fmt::format("The base and the response are exchanged: put right, one mode {}.{}", then, wrong);
    case ChannelFault::Kind::none:
      break;
  }
  if (!event.response) return {};
  if (event.response->damping_ratio > much_damped)
    return fmt::format(
        "A damping ratio of {:.3g} % is of no resonance: base and response may be exchanged, or "
        "the band holds no mode.",
        100.0 * event.response->damping_ratio);
  if (event.response->left_percent > much_left)
    return fmt::format(
        "One mode does not explain {:.3g} % of the motion in its band: another cause moves the response, or "
        "several modes do. f1 and the damping ratio may be further off than their standard deviations.",
        event.response->left_percent);
  return {};
}

Event event_of(const std::string& name, const Record& record,
               const std::optional<std::pair<double, double>>& band_hz) {
  Index base = -1, response = -1;
  for (std::size_t i = 0; i < record.channels.size(); ++i) {
    if (record.channels[i].quantity == Quantity::base_acceleration) base = static_cast<Index>(i);
    if (record.channels[i].quantity == Quantity::acceleration) response = static_cast<Index>(i);
  }
  if (base < 0 || response < 0)
    throw std::invalid_argument(
        fmt::format("{}: no channel of {}; expected one of base_acceleration (the borehole) "
                    "and one of acceleration (the surface)",
                    name, base < 0 ? "base_acceleration" : "acceleration"));
  const VectorXd u = record.samples.row(base), y = record.samples.row(response);
  Event event{name, record.channels[static_cast<std::size_t>(response)].name,
              0.0,  0.0,
              {},   {},
              {},   record.interval()};
  event.peak = (y.array() - y.mean()).abs().maxCoeff();
  event.base_peak = (u.array() - u.mean()).abs().maxCoeff();
  try {
    event.response = base_response(u, y, record.interval(), band_hz);
  } catch (const std::invalid_argument& error) {
    event.reason = error.what();
  }
  event.fault = channel_fault(u, y, event.interval);
  return event;
}

Table events_table(const std::vector<Event>& events) {
  Table table{"events", "First mode of every event"};
  table.column({"record", "record"})
      .column({"PGA [m/s2]", "pga_m_per_s2", "{:.3g}"})
      .column({"of the base", "base_pga_m_per_s2", "{:.3g}"})
      .column({"f1 [Hz]", "frequency_hz", "{:.4g}"})
      .column({"deviation", "frequency_standard_deviation_hz", "{:.2g}"})
      .column({"damping ratio [%]", "damping_ratio_percent", "{:.3g}"})
      .column({"deviation", "damping_ratio_standard_deviation_percent", "{:.2g}"})
      .column({"residual [%]", "left_percent", "{:.3g}"});
  for (const Event& one : events) {
    const BaseResponse none{std::nan(""), std::nan(""), std::nan(""), std::nan(""), 0.0, std::nan(""), {}};
    const BaseResponse& found = one.response ? *one.response : none;
    table.row({one.name, one.peak, one.base_peak, found.frequency_hz, found.frequency_deviation_hz,
               100.0 * found.damping_ratio, 100.0 * found.damping_ratio_deviation, found.left_percent});
  }
  table.note =
      "PGA: the largest acceleration at the surface. Residual: of the motion relative to the base in the "
      "band fitted, what one mode does not explain.";
  return table;
}

Figure events_figure(const std::vector<Event>& events) {
  std::vector<const Event*> shown;
  for (const Event& one : events)
    if (one.response && !one.fault.surely()) shown.push_back(&one);
  const auto count = static_cast<Index>(shown.size());
  VectorXd peak(count), f(count), f_half(count), xi(count), xi_half(count);
  for (Index i = 0; i < count; ++i) {
    const BaseResponse& found = *shown[static_cast<std::size_t>(i)]->response;
    peak[i] = shown[static_cast<std::size_t>(i)]->peak;
    f[i] = found.frequency_hz, f_half[i] = quantile_95 * found.frequency_deviation_hz;
    xi[i] = 100.0 * found.damping_ratio, xi_half[i] = 100.0 * quantile_95 * found.damping_ratio_deviation;
  }
  const Axis peaks{"PGA [m/s^{2}]", true};
  Figure figure{"f1_over_pga",
                {Panel{"", peaks, {"f_{1} [Hz], bars: 95 %"}}
                     .bars("", peak, f, f - f_half, f + f_half)
                     .key(Legend::none),
                 Panel{"", peaks, {"damping ratio [%], bars: 95 %"}}
                     .bars("", peak, xi, xi - xi_half, xi + xi_half)
                     .key(Legend::none)},
                1,
                2,
                1000};
  figure.caption =
      "First frequency and damping ratio of every event over its peak acceleration, with 95 % intervals.";
  return figure;
}

// From the weakest event to the strongest.
std::string change_sentence(const std::vector<Event>& events) {
  const Event *weakest = nullptr, *strongest = nullptr;
  for (const Event& one : events) {
    if (!one.response || one.fault.surely()) continue;
    if (!weakest || one.peak < weakest->peak) weakest = &one;
    if (!strongest || one.peak > strongest->peak) strongest = &one;
  }
  if (weakest == strongest) return {};
  const BaseResponse &low = *weakest->response, &high = *strongest->response;
  const double change = high.frequency_hz / low.frequency_hz - 1.0,
               deviation = std::hypot(high.frequency_deviation_hz / high.frequency_hz,
                                      low.frequency_deviation_hz / low.frequency_hz);
  const std::string peaks = fmt::format("from {:.3g} to {:.3g} m/s2", weakest->peak, strongest->peak);
  if (std::abs(change) < quantile_95 * deviation)
    return fmt::format("{}, f1 does not change beyond its standard deviation, {:.2g} %.", peaks,
                       100.0 * deviation);
  return fmt::format(
      "{}, f1 goes from {:.4g} to {:.4g} Hz ({:+.1f} %): as if the stiffness changed by {:+.0f} %.", peaks,
      low.frequency_hz, high.frequency_hz, 100.0 * change, 100.0 * ((1.0 + change) * (1.0 + change) - 1.0));
}

}  // namespace

Results event_report(const std::vector<std::string>& names, const std::vector<Record>& records,
                     const std::optional<std::pair<double, double>>& band_hz) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < records.size(); ++i) events.push_back(event_of(names[i], records[i], band_hz));
  Results results;
  results.command = "modal";
  results.configuration["method"] = "base_response";
  bool contradicted = false;
  const bool none =
      std::none_of(events.begin(), events.end(), [](const Event& one) { return one.response.has_value(); });
  for (const Event& one : events) {
    if (!one.response) results.warning(fmt::format("{}: {}.", one.name, one.reason), none);
    if (const std::string text = fault_sentence(one); !text.empty())
      results.warning(fmt::format("{}: {}", one.name, text), one.fault.surely());
    contradicted = contradicted || one.fault.surely();
  }
  results.values["status"] = contradicted ? "contradicted" : "converged";
  if (const std::string change = change_sentence(events); !change.empty())
    results.paragraph("With the peak acceleration " + change);
  results.table(events_table(events));
  results.values["events"] = nlohmann::ordered_json::array();
  for (const Event& one : events) {
    nlohmann::ordered_json entry{{"record", one.name},
                                 {"channel", one.channel},
                                 {"pga_m_per_s2", one.peak},
                                 {"base_pga_m_per_s2", one.base_peak}};
    if (one.response) {
      entry["frequency_hz"] = one.response->frequency_hz;
      entry["frequency_standard_deviation_hz"] = one.response->frequency_deviation_hz;
      entry["damping_ratio"] = one.response->damping_ratio;
      entry["damping_ratio_standard_deviation"] = one.response->damping_ratio_deviation;
      entry["participation"] = one.response->participation;
      entry["left_percent"] = one.response->left_percent;
      entry["band_hz"] = {one.response->band_hz.first, one.response->band_hz.second};
    } else {
      entry["reason"] = one.reason;
    }
    if (const std::string text = fault_sentence(one); !text.empty()) entry["fault"] = text;
    if (one.fault.kind == ChannelFault::Kind::late) entry["late_s"] = one.fault.samples * one.interval;
    results.values["events"].push_back(std::move(entry));
  }
  if (std::any_of(events.begin(), events.end(),
                  [](const Event& one) { return one.response.has_value() && !one.fault.surely(); }))
    results.figures.push_back(events_figure(events));
  return results;
}

}  // namespace beamid::experiments
