#include "experiments/sweep/sweep_plan.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

#include "experiments/text/choice_text.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using filters::OptionValue;
using Law = VariedKey::Law;

[[noreturn]] void refuse_value(const std::string& text, const std::string& expected) {
  throw std::invalid_argument(fmt::format("'{}'; expected {}", text, expected));
}

double number_in(const std::string& text, const std::string& part) {
  const std::optional<double> value = number(part);
  if (!value) refuse_value(text, fmt::format("a number in the place of '{}'", part));
  return *value;
}

OptionValue value_of(const std::string& word) {
  if (const auto value = number(word)) return *value;
  if (word == "true" || word == "false") return word == "true";
  return word;
}

std::optional<Law> law_of(const std::string& word) {
  if (word == "uniform") return Law::uniform;
  if (word == "log_uniform") return Law::log_uniform;
  if (word == "normal") return Law::normal;
  return {};
}

void read_law(VariedKey& varied, const std::vector<std::string>& parts) {
  if (parts.size() != 3)
    refuse_value(varied.text, varied.law == Law::normal ? "KEY=normal:MEAN:DEVIATION"
                                                        : fmt::format("KEY={}:FROM:TO", parts[0]));
  varied.first = number_in(varied.text, parts[1]);
  varied.second = number_in(varied.text, parts[2]);
  if (varied.law == Law::normal && !(varied.second > 0.0))
    refuse_value(varied.text, "a positive standard deviation");
  if (varied.law != Law::normal && !(varied.first < varied.second))
    refuse_value(varied.text, "FROM below TO");
  if (varied.law == Law::log_uniform && !(varied.first > 0.0))
    refuse_value(varied.text, "positive FROM and TO");
}

void read_range(VariedKey& varied, const std::vector<std::string>& parts) {
  constexpr double most_steps = 1e6;
  const bool logarithmic = parts.size() == 4;
  if (logarithmic && parts[3] != "log")
    refuse_value(varied.text, "KEY=FROM:TO:STEPS or KEY=FROM:TO:STEPS:log");
  const double from = number_in(varied.text, parts[0]), to = number_in(varied.text, parts[1]);
  const double steps = number_in(varied.text, parts[2]);
  if (!(steps >= 2.0 && steps <= most_steps && steps == std::floor(steps)))
    refuse_value(varied.text, fmt::format("a whole number of steps from 2 to {:g}", most_steps));
  if (logarithmic && !(from > 0.0 && to > 0.0)) refuse_value(varied.text, "positive FROM and TO");
  const int last = static_cast<int>(steps) - 1;
  for (int i = 0; i <= last; ++i) {
    const double share = static_cast<double>(i) / last;
    const double value = logarithmic ? from * std::pow(to / from, share) : from + (to - from) * share;
    varied.values.emplace_back(i == 0 ? from : i == last ? to : value);
  }
}

OptionValue drawn(const VariedKey& varied, filters::RandomStream& stream) {
  if (varied.law == Law::normal) return varied.first + varied.second * stream.normal(1, 1)(0, 0);
  const double share = stream.uniform();
  if (varied.law == Law::uniform) return varied.first + (varied.second - varied.first) * share;
  return varied.first * std::pow(varied.second / varied.first, share);
}

}  // namespace

std::size_t SweepPlan::points() const {
  std::size_t count = 1;
  for (const VariedKey& one : varied)
    if (one.law == Law::grid) count *= one.values.size();
  return count;
}

std::size_t SweepPlan::cases() const {
  return points() * static_cast<std::size_t>(samples) * static_cast<std::size_t>(seeds);
}

std::size_t SweepPlan::point_of(std::size_t number) const {
  return number / (static_cast<std::size_t>(samples) * static_cast<std::size_t>(seeds));
}

VariedKey parse_varied(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dot = text.rfind('.', equals);
  if (equals == std::string::npos || dot == std::string::npos || dot == 0 || dot + 1 == equals ||
      equals + 1 == text.size())
    refuse_value(text, "TABLE.KEY=FROM:TO:STEPS, TABLE.KEY=A,B,C or TABLE.KEY=uniform:FROM:TO");
  VariedKey varied;
  varied.text = text;
  varied.key = text.substr(0, equals);
  const std::string rest = text.substr(equals + 1);
  const std::vector<std::string> parts = split(rest, ':');
  if (const auto law = law_of(parts[0])) {
    varied.law = *law;
    read_law(varied, parts);
  } else if (parts.size() == 3 || parts.size() == 4) {
    read_range(varied, parts);
  } else if (parts.size() == 1) {
    for (const std::string& word : split(rest, ',')) {
      if (word.empty()) refuse_value(text, "a value between commas");
      varied.values.push_back(value_of(word));
    }
  } else {
    refuse_value(text, "TABLE.KEY=FROM:TO:STEPS, TABLE.KEY=A,B,C or TABLE.KEY=uniform:FROM:TO");
  }
  return varied;
}

std::vector<OptionValue> values_of_point(const SweepPlan& plan, std::size_t point) {
  std::vector<OptionValue> values(plan.varied.size());
  for (std::size_t j = plan.varied.size(); j-- > 0;) {
    const VariedKey& one = plan.varied[j];
    if (one.law != Law::grid) {
      values[j] = one.text.substr(one.key.size() + 1);
      continue;
    }
    values[j] = one.values[point % one.values.size()];
    point /= one.values.size();
  }
  return values;
}

std::vector<OptionValue> values_of(const SweepPlan& plan, std::size_t number) {
  std::vector<OptionValue> values = values_of_point(plan, plan.point_of(number));
  filters::RandomStream stream(plan.seed, number / static_cast<std::size_t>(plan.seeds));
  for (std::size_t j = 0; j < values.size(); ++j)
    if (plan.varied[j].law != Law::grid) values[j] = drawn(plan.varied[j], stream);
  return values;
}

void check(const SweepPlan& plan) {
  std::set<std::string> keys;
  bool drawn = false;
  double count = static_cast<double>(plan.samples) * plan.seeds;
  for (const VariedKey& one : plan.varied) {
    if (!keys.insert(one.key).second)
      throw std::invalid_argument(fmt::format("'{}' is varied twice; expected each key once", one.key));
    drawn = drawn || one.law != Law::grid;
    if (one.law == Law::grid) count *= static_cast<double>(one.values.size());
  }
  if (plan.samples > 1 && !drawn)
    throw std::invalid_argument(fmt::format(
        "{} random samples and no key to draw; expected one varied as KEY=uniform:FROM:TO", plan.samples));
  if (count > most_cases)
    throw std::invalid_argument(fmt::format("{:g} cases; expected {:g} at most", count, most_cases));
}

}  // namespace beamid::experiments
