#include "experiments/studies/inspect/inspection_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/record/record_table.hpp"
#include "experiments/record/stamps.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json inspection_to_json(const Inspection& found, const InspectedChannel& c) {
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
            {"dead", c.defects.dead},
            {"missing", c.missing}};
  const auto runs = [&](const std::vector<Run>& all) {
    Json list = Json::array();
    for (const Run& run : all)
      list.push_back({{"time_s", found.time[run.first]},
                      {"samples", run.length},
                      {"value", std::isfinite(run.value) ? Json(run.value) : Json(nullptr)}});
    return list;
  };
  json["clipped"] = runs(c.defects.clipped);
  json["dropped"] = runs(c.defects.dropped);
  json["spikes"] = runs(c.defects.spikes);
  json["repeated_samples"] = samples_in(c.defects.repeated);
  if (const auto& rattle = c.defects.rattle)
    json["rattle"] = {
        {"from_s", found.time[rattle->first]}, {"to_s", found.time[rattle->last]}, {"ratio", rattle->ratio}};
  if (c.wandering)
    json["offset_drift"] = {
        {"from", c.wandering->from}, {"to", c.wandering->to}, {"start_up", c.wandering->start_up}};
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
    results.values["channels"].push_back(inspection_to_json(found, channel));
  const std::vector<std::string> warnings = inspection_warnings(found);
  results.values["findings"] = warnings;

  results.heading(found.file);
  std::string text = fmt::format("Read as {}. {}", found.reader, sampling_text(found));
  for (const std::string& remark : found.remarks) text += " " + remark;
  results.paragraph(text);
  results.table(channel_table(found));
  Table events = event_table(found);
  if (events.rows() > 0) results.table(std::move(events));
  std::string list;
  for (const std::string& warning : warnings) list += (list.empty() ? "- " : "\n- ") + warning;
  results.paragraph(list.empty() ? "No problems found." : list);
  const std::string lines = record_table_text(found);
  results.values["record_table"] = lines;
  const bool open = lines.find("...") != std::string::npos;
  results.paragraph(fmt::format("Table for an experiment file{}:\n\n", open ? "; replace each \"...\"" : "") +
                    lines);
  results.draw([&] { return inspection_figures(found); });
  return results;
}

namespace {

std::string number_text(double value) {
  return fmt::format("{:.4g}", value);
}

std::string size_of(const InspectedChannel& channel, double value) {
  return number_text(value) + (channel.unit.empty() ? "" : " " + channel.unit);
}

std::string located(const Inspection& found, const std::vector<std::size_t>& samples) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, samples.size()); ++i)
    text += fmt::format("{}{:.6g}{}", i ? ", " : "", found.time[samples[i]], found.has_time ? " s" : "");
  return text + (samples.size() > most ? ", ..." : "");
}

/// Adds what is wrong with one channel.
void add_channel_warnings(const Inspection& found, const InspectedChannel& c, std::vector<std::string>& all) {
  const Defects& d = c.defects;
  const std::string name = title(c);
  const auto at = [&](std::size_t sample) {
    return fmt::format("{:.6g}{}", found.time[sample], found.has_time ? " s" : "");
  };
  if (d.dead) {
    all.push_back(fmt::format("{}: dead{}. {} with a spread of {}: no vibration that could be used.", name,
                              d.spikes.empty() ? "" : " but for spikes", size_of(c, c.offset),
                              size_of(c, c.greatest - c.least)));
    return;
  }
  if (!d.spikes.empty())
    all.push_back(fmt::format("{}: {} spike{}{} at {}. Neighbouring samples do not move, so {} no motion.",
                              name, d.spikes.size(), d.spikes.size() == 1 ? ", " : "s, the first ",
                              size_of(c, d.spikes.front().value), at(d.spikes.front().first),
                              d.spikes.size() == 1 ? "it is" : "they are"));
  if (!d.clipped.empty())
    all.push_back(fmt::format("{}: clipped at {}, {} run{} of {} samples in all, first at {}.", name,
                              size_of(c, d.clipped.front().value), d.clipped.size(),
                              d.clipped.size() == 1 ? "" : "s", samples_in(d.clipped),
                              at(d.clipped.front().first)));
  if (!d.dropped.empty())
    all.push_back(
        fmt::format("{}: {} drop-out{} of {} samples in all ({}), first at {}.", name, d.dropped.size(),
                    d.dropped.size() == 1 ? "" : "s", samples_in(d.dropped),
                    c.missing ? fmt::format("{} of them hold no number", c.missing) : "runs of one value",
                    at(d.dropped.front().first)));
  if (!d.repeated.empty())
    all.push_back(fmt::format(
        "{}: {} samples ({:.2g} %) repeat the one before, which rounding does not explain: "
        "readings sent twice.",
        name, samples_in(d.repeated),
        100 * static_cast<double>(samples_in(d.repeated)) / static_cast<double>(c.samples.size())));
  if (d.rattle)
    all.push_back(
        fmt::format("{}: rattle from {} to {}, broadband noise {:.3g} times that of the rest, while the "
                    "motion is large: a loose contact. What is damped there is not the beam.",
                    name, at(d.rattle->first), at(d.rattle->last), d.rattle->ratio));
  if (c.wandering && c.wandering->start_up)
    all.push_back(
        fmt::format("{}: begins with a start-up, not with a hit: its offset settles from {} to {} "
                    "until {}.",
                    name, size_of(c, c.wandering->from), size_of(c, c.wandering->to),
                    at(static_cast<std::size_t>(c.wandering->settled))));
  else if (c.wandering)
    all.push_back(
        fmt::format("{}: its offset drifts between {} and {}. A step high_pass or detrend takes that out.",
                    name, size_of(c, c.wandering->from), size_of(c, c.wandering->to)));
  constexpr double rebound_s = 0.1;
  for (std::size_t k = 1; found.has_time && k < c.events.size(); ++k) {
    const double before = found.time[static_cast<std::size_t>(c.events[k - 1].sample)],
                 now = found.time[static_cast<std::size_t>(c.events[k].sample)];
    if (c.events[k].pulse && now - before < rebound_s) {
      all.push_back(
          fmt::format("{}: a second pulse {:.3g} ms after the one at {:.6g} s: the hammer rebounded.", name,
                      1000 * (now - before), before));
      break;
    }
  }
  constexpr double poor_db = 20.0;
  if (c.noise > 0 && c.signal_to_noise_db < poor_db)
    all.push_back(fmt::format("{}: signal-to-noise ratio of {:.1f} dB only, over the whole record.", name,
                              c.signal_to_noise_db));
  if (spiky(c))
    all.push_back(fmt::format("{}: {} sudden rises, more than a test has hits: spikes or bad contact.", name,
                              c.events.size()));
  const double spread = c.greatest - c.least;
  if (std::abs(c.offset) > 0.1 * spread)
    all.push_back(fmt::format("{}: an offset of {}, {:.0f} % of its range.", name, size_of(c, c.offset),
                              100 * std::abs(c.offset) / spread));
}

}  // namespace

std::string title(const InspectedChannel& channel) {
  std::string name = channel.name.empty() ? fmt::format("column {}", channel.column) : channel.name;
  std::string lower = name;
  for (char& letter : lower)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  const bool told = !channel.quantity || lower.find(to_string(*channel.quantity)) != std::string::npos;
  return told ? name : fmt::format("{} ({})", name, to_string(*channel.quantity));
}

bool spiky(const InspectedChannel& channel) {
  constexpr std::size_t most = 50;
  return channel.events.size() > most;
}

std::string unit_text(const InspectedChannel& channel) {
  return channel.unit.empty() ? "as in the file" : channel.unit;
}

std::string sampling_text(const Inspection& found) {
  const SamplingCheck& s = found.sampling;
  const std::size_t count = found.time.size();
  const double duration = found.time.back() - found.time.front();
  if (!found.has_time) return fmt::format("{} samples. {}", count, found.time_text);
  std::string text = fmt::format("{} samples from {:.6g} to {:.6g} s ({:.6g} s). {} ", count,
                                 found.time.front(), found.time.back(), duration, found.time_text);
  const double rate = static_cast<double>(count - 1) / duration;
  const auto even = without_rounding(found.time, found.resolution);
  if (found.mean_rate)
    text += "The rate is not certain.";
  else if (s.uniform)
    text += fmt::format("Evenly sampled at {:.8g} Hz.", even ? 1.0 / even->interval : rate);
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

std::vector<std::string> inspection_warnings(const Inspection& found) {
  std::vector<std::string> all = found.warnings;
  const SamplingCheck& s = found.sampling;
  if (!found.skipped_lines.empty())
    all.push_back(skipped_text(found.skipped_lines, "is not a row of numbers like the others") +
                  " Other commands refuse such lines without --skip-malformed.");
  if (!s.gaps.empty())
    all.push_back(fmt::format("{} gap{}, up to {:.4g} s long, before {}.", s.gaps.size(),
                              s.gaps.size() == 1 ? "" : "s", s.longest_gap, located(found, s.gaps)));
  if (!s.repeats.empty())
    all.push_back(fmt::format("{} repeated stamp{}: {}.", s.repeats.size(), s.repeats.size() == 1 ? "" : "s",
                              located(found, s.repeats)));
  if (!s.returns.empty()) all.push_back(fmt::format("Time runs backwards at {}.", located(found, s.returns)));
  if (!s.uniform && s.gaps.empty() && s.repeats.empty() && s.returns.empty())
    all.emplace_back(
        "The sampling interval is not constant: filters take the stamps as they are, what needs even samples "
        "resamples the record.");
  for (const InspectedChannel& channel : found.channels) add_channel_warnings(found, channel, all);
  if (std::none_of(found.channels.begin(), found.channels.end(),
                   [](const auto& c) { return c.quantity.has_value(); }))
    all.emplace_back(
        "The file does not state what the channels measure. State it for other commands: "
        "--column N --quantity acceleration --unit g, or [record] in an experiment file.");
  return all;
}

std::string record_table_text(const Inspection& found) {
  std::string text = fmt::format("[record]\nfile = \"{}\"\n", found.file);
  if (!found.time_key.empty()) text += found.time_key + "\n";
  if (!found.has_time) text += "sampling_rate_hz = ...  # samples per second\n";
  const bool stated = std::all_of(found.channels.begin(), found.channels.end(),
                                  [](const auto& c) { return c.quantity.has_value() && !c.defects.dead; });
  std::string channels;
  for (const InspectedChannel& c : found.channels)
    if (!c.defects.dead)
      channels += fmt::format("  {{ column = {}, quantity = \"{}\", unit = \"{}\" }},\n", c.column,
                              c.quantity ? to_string(*c.quantity) : "...", c.quantity ? c.file_unit : "...");
  if (!stated && !channels.empty()) text += "channels = [\n" + channels + "]\n";
  for (const InspectedChannel& c : found.channels) {
    if (c.events.empty() || c.events.front().pulse || !(c.frequency_hz > 0) || spiky(c) || !found.has_time)
      continue;
    constexpr double settling = 3;  // periods
    const double from =
        found.time[static_cast<std::size_t>(c.events.back().sample)] + settling / c.frequency_hz;
    if (from >= found.time.back()) continue;
    text += fmt::format("window_s = [{:.4g}, {:.4g}]  # three periods behind the last event\n", from,
                        std::floor(1e4 * found.time.back()) / 1e4);
    break;
  }
  if (std::any_of(found.channels.begin(), found.channels.end(),
                  [](const auto& c) { return c.wandering.has_value(); }))
    text += "[[record.prepare]]\nstep = \"detrend\"\norder = 3\n";
  return text;
}

}  // namespace beamid::experiments
