#include "experiments/preparation/preparation_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace beamid::experiments {

StepRegistry& step_registry() {
  static StepRegistry registry("preparation step");
  return registry;
}

double even_interval(const Record& record) {
  constexpr double tolerated = 0.05;
  const double mean = record.interval();
  for (Eigen::Index k = 1; k < record.size(); ++k)
    if (const double interval = record.time[k] - record.time[k - 1];
        !(std::abs(interval - mean) <= tolerated * mean + 1.000001 * record.time_resolution))
      throw std::invalid_argument(fmt::format(
          "an interval of {:.6g} s at {:.6g} s where the mean one is {:.6g} s; expected even sampling, which "
          "a step = \"resample\" before this one makes",
          interval, record.time[k], mean));
  return mean;
}

int whole_option(const filters::Options& options, const std::string& name, int least, int most) {
  const double value = options.number(name);
  if (!(value >= least && value <= most && value == std::floor(value)))
    throw std::invalid_argument(
        fmt::format("{} is {:g}; expected a whole number from {} to {}", name, value, least, most));
  return static_cast<int>(value);
}

std::string word_option(const filters::Options& options, const std::string& name,
                        const std::vector<std::string>& words) {
  const std::string& value = options.text(name);
  if (std::find(words.begin(), words.end(), value) == words.end())
    throw std::invalid_argument(fmt::format("{} is '{}'; expected {}", name, value, fmt::join(words, ", ")));
  return value;
}

}  // namespace beamid::experiments
