#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/input/record_table.hpp"
#include "experiments/inspection/inspection.hpp"
#include "experiments/signal/amplitude_spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;

std::string title(const InspectedChannel& channel) {
  std::string name = channel.name.empty() ? fmt::format("column {}", channel.column) : channel.name;
  std::string lower = name;
  for (char& letter : lower)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  const bool told = !channel.quantity || lower.find(to_string(*channel.quantity)) != std::string::npos;
  return told ? name : fmt::format("{} ({})", name, to_string(*channel.quantity));
}

/// More rises than a test has hits.
bool spiky(const InspectedChannel& channel) {
  constexpr std::size_t most = 50;
  return channel.events.size() > most;
}

std::string unit_text(const InspectedChannel& channel) {
  return channel.unit.empty() ? "as in the file" : channel.unit;
}

std::string number(double value) {
  return fmt::format("{:.4g}", value);
}

std::string size_of(const InspectedChannel& channel, double value) {
  return number(value) + (channel.unit.empty() ? "" : " " + channel.unit);
}

Table channel_table(const Inspection& found) {
  Table table{"channels", "Channels"};
  table.column({"column", "column", "{:.0f}"})
      .column({"name", "name"})
      .column({"unit", "unit"})
      .column({"least", "least", "{:.4g}"})
      .column({"greatest", "greatest", "{:.4g}"})
      .column({"offset", "offset", "{:.3g}"})
      .column({"drift", "drift", "{:.2g}"})
      .column({"noise", "noise", "{:.2g}"})
      .column({"SNR [dB]", "signal_to_noise_db", "{:.1f}"})
      .column({found.has_time ? "f [Hz]" : "f [1/sample]", "frequency_hz", "{:.4g}"})
      .column({"events", "events", "{:.0f}"});
  for (const InspectedChannel& c : found.channels) {
    const double none = std::nan("");
    table.row({static_cast<double>(c.column), title(c), unit_text(c), c.least, c.greatest, c.offset, c.drift,
               c.noise, c.dead ? none : c.signal_to_noise_db, c.frequency_hz > 0 ? c.frequency_hz : none,
               static_cast<double>(c.events.size())});
  }
  table.note =
      "Offset: the median. Drift: change of a fitted line over the record. Noise: standard deviation of what "
      "is "
      "as broad as white noise in the quietest quarter. f: the strongest frequency.";
  return table;
}

Table event_table(const Inspection& found) {
  constexpr std::size_t most = 20;
  Table table{"events", "Events"};
  table.column({"channel", "channel"})
      .column({found.has_time ? "time [s]" : "sample", "time_s", "{:.4f}"})
      .column({"size", "size", "{:.4g}"})
      .column({"unit", "unit"})
      .column({"looks like", "kind"});
  std::size_t left_out = 0;
  for (const InspectedChannel& c : found.channels)
    for (std::size_t k = 0; k < c.events.size() && !spiky(c); ++k) {
      if (k >= most) {
        ++left_out;
        continue;
      }
      const SignalEvent& event = c.events[k];
      table.row({title(c), found.time[static_cast<std::size_t>(event.sample)], event.size, unit_text(c),
                 std::string(event.pulse ? "a pulse: a hit" : "a rise: a hit or a release")});
    }
  if (left_out > 0) table.note = fmt::format("{} more are in results.json.", left_out);
  return table;
}

std::string located(const Inspection& found, const std::vector<std::size_t>& samples) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, samples.size()); ++i)
    text += fmt::format("{}{:.6g}{}", i ? ", " : "", found.time[samples[i]], found.has_time ? " s" : "");
  return text + (samples.size() > most ? ", ..." : "");
}

std::string sampling_text(const Inspection& found) {
  const SamplingCheck& s = found.sampling;
  const std::size_t count = found.time.size();
  const double duration = found.time.back() - found.time.front();
  if (!found.has_time) return fmt::format("{} samples. {}", count, found.time_text);
  std::string text = fmt::format("{} samples from {:.6g} to {:.6g} s ({:.6g} s). {} ", count,
                                 found.time.front(), found.time.back(), duration, found.time_text);
  const double rate = static_cast<double>(count - 1) / duration;
  if (s.uniform)
    text += fmt::format("Evenly sampled at {:.8g} Hz.", rate);
  else
    text += fmt::format("Not evenly sampled: {:.6g} samples a second in the mean, median interval {:.6g} s.",
                        rate, s.interval);
  if (s.jitter > 1e-9 * s.interval)
    text += found.resolution > 0 && s.jitter <= found.resolution
                ? fmt::format(
                      " The intervals scatter by {:.2g} s, as the rounding of the stamps to {:.2g} s does.",
                      s.jitter, found.resolution)
                : fmt::format(" The intervals scatter by {:.2g} s ({:.2g} %).", s.jitter,
                              100 * s.jitter / s.interval);
  return text;
}

std::vector<std::string> warnings(const Inspection& found) {
  std::vector<std::string> all;
  const SamplingCheck& s = found.sampling;
  if (!found.skipped_lines.empty())
    all.push_back(skipped_text(found.skipped_lines, "is not a row of numbers like the others") +
                  " Other commands refuse such lines unless told --skip-malformed.");
  if (!s.gaps.empty())
    all.push_back(fmt::format("{} gap{}, up to {:.4g} s long, before {}.", s.gaps.size(),
                              s.gaps.size() == 1 ? "" : "s", s.longest_gap, located(found, s.gaps)));
  if (!s.repeats.empty())
    all.push_back(fmt::format("{} repeated stamp{}: {}.", s.repeats.size(), s.repeats.size() == 1 ? "" : "s",
                              located(found, s.repeats)));
  if (!s.returns.empty()) all.push_back(fmt::format("Time runs backwards at {}.", located(found, s.returns)));
  if (!s.uniform && s.gaps.empty() && s.repeats.empty() && s.returns.empty())
    all.emplace_back(
        "The sampling interval is not constant: --stamps as_they_are takes the stamps as they are.");
  for (const InspectedChannel& c : found.channels) {
    const auto lengths = [](const std::vector<Run>& runs) {
      std::size_t sum = 0;
      for (const Run& run : runs) sum += run.length;
      return sum;
    };
    const std::string name = title(c);
    if (c.dead) {
      all.push_back(fmt::format("{}: dead. {} with a spread of {}: no vibration that could be used.", name,
                                size_of(c, c.offset), size_of(c, c.greatest - c.least)));
      continue;
    }
    if (!c.clipped.empty())
      all.push_back(fmt::format("{}: clipped at {}, {} run{} of {} samples in all, first at {:.6g}{}.", name,
                                size_of(c, c.clipped.front().value), c.clipped.size(),
                                c.clipped.size() == 1 ? "" : "s", lengths(c.clipped),
                                found.time[c.clipped.front().first], found.has_time ? " s" : ""));
    if (!c.dropped.empty())
      all.push_back(
          fmt::format("{}: {} drop-out{} of {} samples in all ({}), first at {:.6g}{}.", name,
                      c.dropped.size(), c.dropped.size() == 1 ? "" : "s", lengths(c.dropped),
                      c.missing ? fmt::format("{} of them hold no number", c.missing) : "runs of one value",
                      found.time[c.dropped.front().first], found.has_time ? " s" : ""));
    constexpr double poor_db = 20.0;
    if (c.noise > 0 && c.signal_to_noise_db < poor_db)
      all.push_back(fmt::format("{}: signal-to-noise ratio of {:.1f} dB only, over the whole record.", name,
                                c.signal_to_noise_db));
    if (spiky(c))
      all.push_back(fmt::format("{}: {} sudden rises, more than a test has hits: spikes or bad contact.",
                                name, c.events.size()));
    const double spread = c.greatest - c.least;
    if (std::abs(c.offset) > 0.1 * spread)
      all.push_back(fmt::format("{}: an offset of {}, {:.0f} % of its range.", name, size_of(c, c.offset),
                                100 * std::abs(c.offset) / spread));
  }
  if (std::none_of(found.channels.begin(), found.channels.end(),
                   [](const auto& c) { return c.quantity.has_value(); }))
    all.emplace_back(
        "Nothing says what the channels measure. State it for other commands: "
        "--column N --quantity acceleration --unit g, or [record] in an experiment file.");
  return all;
}

VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

void add_panels(const Inspection& found, const InspectedChannel& channel, Figure& figure) {
  const VectorXd time = vector_of(found.time), samples = vector_of(channel.samples);
  const std::string unit = channel.unit.empty() ? "" : " [" + channel.unit + "]";
  Panel history{title(channel), {found.has_time ? "time [s]" : "sample"}, {title(channel) + unit}, {}};
  history.title = "";
  history.curves.push_back({"", time, samples, CurveStyle::line, {}, {}, Colour::blue});
  if (!channel.events.empty() && !spiky(channel)) {
    VectorXd at(channel.events.size()), value(channel.events.size());
    for (Index k = 0; k < at.size(); ++k) {
      const SignalEvent& event = channel.events[static_cast<std::size_t>(k)];
      at[k] = time[event.sample], value[k] = channel.offset + event.size;
    }
    history.curves.push_back({"event", at, value, CurveStyle::open_points, {}, {}, Colour::vermillion});
  }
  history.x_axis.range = {time[0], time[time.size() - 1]};
  history.legend = Legend::none;
  figure.panels.push_back(std::move(history));

  VectorXd filled = samples;
  for (Index k = 0; k < filled.size(); ++k)
    if (!std::isfinite(filled[k])) filled[k] = channel.offset;
  const double interval = (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  AmplitudeSpectrum spectrum = amplitude_spectrum(filled, interval > 0 ? interval : 1.0);
  const double top = spectrum.amplitude.maxCoeff();
  const Index kept = spectrum.amplitude.size() - 1;
  Panel panel{
      "", {found.has_time ? "frequency [Hz]" : "frequency [1/sample]"}, {"amplitude" + unit, true}, {}};
  panel.curves.push_back({"",
                          spectrum.frequency_hz.tail(kept),
                          spectrum.amplitude.tail(kept).cwiseMax(1e-6 * top),
                          CurveStyle::line,
                          {},
                          {},
                          Colour::black});
  panel.x_axis.range = {0.0, spectrum.frequency_hz[kept]};
  panel.legend = Legend::none;
  figure.panels.push_back(std::move(panel));
}

std::vector<Figure> figures(const Inspection& found) {
  constexpr std::size_t rows = 4;
  std::vector<Figure> all;
  std::vector<const InspectedChannel*> shown;
  for (const InspectedChannel& channel : found.channels)
    if (channel.greatest > channel.least && found.time.size() >= 16) shown.push_back(&channel);
  for (std::size_t first = 0; first < shown.size(); first += rows) {
    const std::size_t count = std::min(rows, shown.size() - first);
    Figure figure{
        first == 0 ? "record" : fmt::format("record_{}", first / rows + 1), {}, static_cast<int>(count), 2};
    figure.width = 1000;
    for (std::size_t k = 0; k < count; ++k) add_panels(found, *shown[first + k], figure);
    all.push_back(std::move(figure));
  }
  return all;
}

Json to_json(const Inspection& found, const InspectedChannel& c) {
  Json json{{"column", c.column},
            {"name", c.name},
            {"unit", c.unit},
            {"quantity", c.quantity ? Json(to_string(*c.quantity)) : Json(nullptr)},
            {"least", c.least},
            {"greatest", c.greatest},
            {"offset", c.offset},
            {"drift", c.drift},
            {"noise", c.noise},
            {"signal_to_noise_db", c.signal_to_noise_db},
            {"frequency_hz", c.frequency_hz},
            {"dead", c.dead},
            {"missing", c.missing}};
  const auto runs = [&](const std::vector<Run>& all) {
    Json list = Json::array();
    for (const Run& run : all)
      list.push_back({{"time_s", found.time[run.first]},
                      {"samples", run.length},
                      {"value", std::isfinite(run.value) ? Json(run.value) : Json(nullptr)}});
    return list;
  };
  json["clipped"] = runs(c.clipped);
  json["dropped"] = runs(c.dropped);
  json["events"] = Json::array();
  for (const SignalEvent& event : c.events)
    json["events"].push_back({{"time_s", found.time[static_cast<std::size_t>(event.sample)]},
                              {"size", event.size},
                              {"pulse", event.pulse}});
  return json;
}

}  // namespace

Results report(const Inspection& found) {
  Results results;
  results.command = "inspect";
  results.configuration = {{"record", found.file}, {"reader", found.reader}};
  const auto times = [&](const std::vector<std::size_t>& samples) {
    Json list = Json::array();
    for (const std::size_t sample : samples) list.push_back(found.time[sample]);
    return list;
  };
  const SamplingCheck& s = found.sampling;
  results.values = {{"samples", found.time.size()},
                    {"start_s", found.time.front()},
                    {"end_s", found.time.back()},
                    {"has_time", found.has_time},
                    {"sampling",
                     {{"uniform", s.uniform},
                      {"interval_s", s.interval},
                      {"jitter_s", s.jitter},
                      {"gaps_s", times(s.gaps)},
                      {"repeated_s", times(s.repeats)},
                      {"backwards_s", times(s.returns)}}},
                    {"skipped_lines", found.skipped_lines}};
  results.values["channels"] = Json::array();
  for (const InspectedChannel& channel : found.channels)
    results.values["channels"].push_back(to_json(found, channel));
  const std::vector<std::string> doubts = warnings(found);
  results.values["doubts"] = doubts;

  results.heading(found.file);
  std::string text = fmt::format("Read as {}. {}", found.reader, sampling_text(found));
  for (const std::string& remark : found.remarks) text += " " + remark;
  results.paragraph(text);
  results.table(channel_table(found));
  Table events = event_table(found);
  if (events.rows() > 0) results.table(std::move(events));
  std::string list;
  for (const std::string& doubt : doubts) list += (list.empty() ? "- " : "\n- ") + doubt;
  results.paragraph(list.empty() ? "Nothing is wrong with it that could be seen." : list);
  results.figures = figures(found);
  return results;
}

}  // namespace beamid::experiments
