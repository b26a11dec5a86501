#include "experiments/record/prepare/channel_step.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace beamid::experiments {
namespace {

bool means(const std::string& name, const Channel& channel) {
  return name == channel.name || name == to_string(channel.quantity);
}

}  // namespace

ChannelStep::ChannelStep(const filters::Options& options) {
  std::istringstream words(options.text("channels"));
  for (std::string word; std::getline(words, word, ',');) {
    word.erase(0, word.find_first_not_of(' '));
    word.erase(word.find_last_not_of(' ') + 1);
    if (word.empty()) throw std::invalid_argument("an empty name in channels; expected names between commas");
    names_.push_back(word);
  }
}

filters::OptionSpec ChannelStep::channels_option() {
  return {"channels", std::string(), "",
          "names or quantities between commas, as in \"acceleration, force\"; empty: all that it suits"};
}

bool ChannelStep::acts_on(const Channel& channel) const {
  return suits(channel.quantity) &&
         (names_.empty() ||
          std::any_of(names_.begin(), names_.end(), [&](const auto& name) { return means(name, channel); }));
}

std::vector<Eigen::Index> ChannelStep::rows(const Record& record) const {
  std::string known;
  for (const Channel& channel : record.channels)
    known += (known.empty() ? "" : ", ") + std::string(to_string(channel.quantity)) +
             (channel.name.empty() ? "" : " '" + channel.name + "'");
  for (const std::string& name : names_)
    if (std::none_of(record.channels.begin(), record.channels.end(),
                     [&](const Channel& channel) { return means(name, channel); }))
      throw std::invalid_argument("no channel '" + name + "'; the record has: " + known);
  std::vector<Eigen::Index> chosen;
  for (std::size_t i = 0; i < record.channels.size(); ++i)
    if (acts_on(record.channels[i])) chosen.push_back(static_cast<Eigen::Index>(i));
  if (chosen.empty()) throw std::invalid_argument("no channel that it suits; the record has: " + known);
  return chosen;
}

std::string ChannelStep::words(const Record& record, const std::vector<Eigen::Index>& rows) {
  std::string text;
  for (const Eigen::Index row : rows)
    text += (text.empty() ? "" : ", ") + std::string(to_string(record.channels[row].quantity)) +
            (record.channels[row].name.empty() ? "" : " '" + record.channels[row].name + "'");
  return text;
}

void ChannelStep::follow(std::vector<FollowedChannel>& channels, std::complex<double> rate,
                         double interval) const {
  for (FollowedChannel& followed : channels)
    if (acts_on(followed.channel)) followed.factor *= factor(rate, interval);
}

FilterStep::FilterStep(const filters::Options& options)
    : ChannelStep(options),
      zero_phase_(options.flag("zero_phase")),
      trim_(options.flag("trim")),
      start_(word_option(options, "start", {"steady", "rest"}) == "rest" ? FilterStart::rest
                                                                         : FilterStart::steady) {}

std::vector<filters::OptionSpec> FilterStep::with_common_options(std::vector<filters::OptionSpec> own) {
  own.push_back({"zero_phase", false, "", "forwards and backwards: no phase shift, the square of the gain"});
  own.push_back({"start", std::string("steady"), "",
                 "causal: before the record lies its first sample (steady) or zero (rest)"});
  own.push_back({"trim", false, "", "cut off the ends, until transients are down to 1e-3"});
  own.push_back(channels_option());
  return own;
}

void FilterStep::need(const char* option, double value) {
  if (!(value > 0))
    throw std::invalid_argument(fmt::format("{} is {}; expected a corner above 0 Hz", option,
                                            value == 0 ? "missing" : fmt::format("{:g}", value)));
}

double FilterStep::settling(double interval) const {
  return static_cast<double>(settling_samples(filter(interval))) * interval;
}

Transient FilterStep::transient(double interval) const {
  if (trim_) return {};
  const double lasting = settling(interval);
  return {lasting, zero_phase_ ? lasting : 0};
}

std::complex<double> FilterStep::factor(std::complex<double> rate, double interval) const {
  return zero_phase_ ? zero_phase_response(filter(interval), rate) : response(filter(interval), rate);
}

std::string FilterStep::apply(Record& record) const {
  const double interval = even_interval(record);
  const CascadedFilter sections = filter(interval);
  const std::vector<Eigen::Index> chosen = rows(record);
  for (const Eigen::Index row : chosen) {
    const Eigen::VectorXd signal = record.samples.row(row).transpose();
    record.samples.row(row) =
        (zero_phase_ ? filter_forward_backward(sections, signal) : filter_causally(sections, signal, start_))
            .transpose();
  }
  const double lasting = settling(interval);
  const char* ends = zero_phase_ ? "at both ends" : "at the start";
  std::string text = fmt::format("{}, {}, of {}; its transients last {:.3g} s {}", name(),
                                 zero_phase_ ? "zero-phase" : "causal", words(record, chosen), lasting, ends);
  if (trim_) {
    const double last = record.time[record.size() - 1];
    record = record.window(record.time[0] + lasting, zero_phase_ ? last - lasting : last);
    text += ", which were cut off";
  }
  return text + ".";
}

}  // namespace beamid::experiments
