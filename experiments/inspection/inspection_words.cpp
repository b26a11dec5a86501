#include "experiments/inspection/inspection_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/input/record_table.hpp"

namespace beamid::experiments {
namespace {

std::string number(double value) {
  return fmt::format("{:.4g}", value);
}

std::string size_of(const InspectedChannel& channel, double value) {
  return number(value) + (channel.unit.empty() ? "" : " " + channel.unit);
}

std::string located(const Inspection& found, const std::vector<std::size_t>& samples) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, samples.size()); ++i)
    text += fmt::format("{}{:.6g}{}", i ? ", " : "", found.time[samples[i]], found.has_time ? " s" : "");
  return text + (samples.size() > most ? ", ..." : "");
}

/// Adds what is wrong with one channel.
void doubt(const Inspection& found, const InspectedChannel& c, std::vector<std::string>& all) {
  const auto lengths = [](const std::vector<Run>& runs) {
    std::size_t sum = 0;
    for (const Run& run : runs) sum += run.length;
    return sum;
  };
  const std::string name = title(c);
  if (c.dead) {
    all.push_back(fmt::format("{}: dead. {} with a spread of {}: no vibration that could be used.", name,
                              size_of(c, c.offset), size_of(c, c.greatest - c.least)));
    return;
  }
  if (!c.clipped.empty())
    all.push_back(fmt::format("{}: clipped at {}, {} run{} of {} samples in all, first at {:.6g}{}.", name,
                              size_of(c, c.clipped.front().value), c.clipped.size(),
                              c.clipped.size() == 1 ? "" : "s", lengths(c.clipped),
                              found.time[c.clipped.front().first], found.has_time ? " s" : ""));
  if (!c.dropped.empty())
    all.push_back(
        fmt::format("{}: {} drop-out{} of {} samples in all ({}), first at {:.6g}{}.", name, c.dropped.size(),
                    c.dropped.size() == 1 ? "" : "s", lengths(c.dropped),
                    c.missing ? fmt::format("{} of them hold no number", c.missing) : "runs of one value",
                    found.time[c.dropped.front().first], found.has_time ? " s" : ""));
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

std::vector<std::string> doubts_of(const Inspection& found) {
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
  for (const InspectedChannel& channel : found.channels) doubt(found, channel, all);
  if (std::none_of(found.channels.begin(), found.channels.end(),
                   [](const auto& c) { return c.quantity.has_value(); }))
    all.emplace_back(
        "Nothing says what the channels measure. State it for other commands: "
        "--column N --quantity acceleration --unit g, or [record] in an experiment file.");
  return all;
}

}  // namespace beamid::experiments
