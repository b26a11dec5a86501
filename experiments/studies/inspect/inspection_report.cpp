#include <fmt/format.h>

#include <cmath>

#include "experiments/studies/inspect/inspection_words.hpp"

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
  results.paragraph("What to write into an experiment file, with what is known put for each \"...\":\n\n" +
                    lines);
  results.figures = inspection_figures(found);
  return results;
}

}  // namespace beamid::experiments
