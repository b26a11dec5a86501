#include "experiments/record/prepare/channel_step.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

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

}  // namespace beamid::experiments
