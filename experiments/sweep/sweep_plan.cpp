#include "experiments/sweep/sweep_plan.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/spelling.hpp"
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

namespace {

/// [sweep] as a file has it.
struct DescribedSweep : SweepPlan {
  std::vector<std::string> vary;
  std::string identify = "compare";
};

const Schema<DescribedSweep>& sweep_keys() {
  using S = DescribedSweep;
  constexpr int largest_seed = 2000000000;
  static const Schema<S> keys =
      Schema<S>("sweep")
          .key("vary", &S::vary,
               "`TABLE.KEY=FROM:TO:STEPS[:log]`, `TABLE.KEY=A,B,C`, or drawn: `TABLE.KEY=uniform:FROM:TO`, "
               "`log_uniform:FROM:TO`, `normal:MEAN:DEVIATION`. The key is any of this page, a table of an "
               "array by its number: `sensors[1].noise_m`; with `truth.` in front it is set in the beam of "
               "`--truth` only",
               "[\"damping.ratio=0.001:0.1:5:log\"]")
          .fallback("none")
          .key("random", &S::samples, {1, most_samples},
               "samples of the keys drawn, for every point of the grid", "10")
          .key("seeds", &S::seeds, {1, most_samples},
               "cases for every sample, each with sensor noise of its own", "200")
          .key("seed", &S::seed, {0, largest_seed},
               "of what is drawn, and of the noise of the first case; case i has this + i in the place of "
               "`simulation.seed`",
               "1")
          .key("identify", &S::identify,
               "`compare`: as `beamid compare` identifies a record. `once`: one pass of the filter from what "
               "is assumed (`[[parameters]]`, else the beam as described), model `sdof`, one reduction, "
               "simulated records only; ten thousand records of 25,000 samples in some ten seconds",
               "\"once\"")
          .one_of({"compare", "once"});
  return keys;
}

const bool sweep_keys_registered = register_keys([]() -> const KeyTable& { return sweep_keys(); },
                                                 [](const TomlTable& table) { read_sweep(table); });

/// "sensors.noise_m" of "truth.sensors[1].noise_m"
std::string path_in_file(const std::string& key) {
  std::string path;
  bool within = false;  // of the brackets
  for (std::size_t i = key.starts_with("truth.") ? std::string("truth.").size() : 0; i < key.size(); ++i) {
    within = within || key[i] == '[';
    if (!within) path += key[i];
    if (key[i] == ']') within = false;
  }
  if (within)
    throw std::invalid_argument(
        fmt::format("'{}' has a bracket that is not closed; expected as sensors[1].noise_m", key));
  return path;
}

/// A value that no experiment may have, told before the first case and not as the failure of every one.
void check_value(const Key& key, const VariedKey& varied, const filters::OptionValue& value) {
  const double* const number = std::get_if<double>(&value);
  const std::string* const text = std::get_if<std::string>(&value);
  bool possible = true;
  switch (key.type) {
    case Key::Type::number:
      possible = number != nullptr && key.range.contains(*number);
      break;
    case Key::Type::whole:
      possible = number != nullptr && key.range.contains(*number) && *number == std::floor(*number);
      break;
    case Key::Type::truth:
      possible = std::holds_alternative<bool>(value);
      break;
    case Key::Type::text:
      possible = text != nullptr && (key.allowed.empty() || std::find(key.allowed.begin(), key.allowed.end(),
                                                                      *text) != key.allowed.end());
      break;
    default:
      break;
  }
  if (!possible)
    throw std::invalid_argument(fmt::format("'{}' sets {} to {}; expected {}", varied.text, varied.key,
                                            word_of(value), key.expected()));
}

}  // namespace

SweepPlan read_sweep(const TomlTable& table) {
  DescribedSweep plan = sweep_keys().read(table);
  at_place(table.value_place("vary"), [&] {
    for (const std::string& text : plan.vary) {
      plan.varied.push_back(parse_varied(text));
      check_key(plan.varied.back());
    }
  });
  plan.once = plan.identify == "once";
  at_place(table.place(), [&] { check(plan); });
  return plan;
}

std::vector<std::string> keys_to_vary(const KeyTable& section) {
  std::vector<std::string> names;
  for (const Key& key : section.keys())
    if (key.type == Key::Type::number || key.type == Key::Type::whole || key.type == Key::Type::truth ||
        key.type == Key::Type::text || key.type == Key::Type::column)
      names.push_back(key.name);
  return names;
}

void check_key(const VariedKey& varied) {
  const std::string path = path_in_file(varied.key);
  const std::size_t dot = path.rfind('.');
  const std::string table = path.substr(0, dot), name = path.substr(dot + 1);
  const KeyTable* const section = find_key_table(table);
  if (section == nullptr || table.empty() || table.starts_with("frame") || table.starts_with("space_frame") ||
      table == "sweep")
    throw std::invalid_argument(fmt::format("'{}' is in no table of an experiment file", varied.key));
  const Key* const key = section->find(name);
  if (key == nullptr && section->has_options()) return;  // its method knows them
  const std::vector<std::string> known = keys_to_vary(*section);
  if (key == nullptr)
    throw std::invalid_argument(
        fmt::format("unknown key '{}' in {}; {}", name, table, known_names(name, known)));
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw std::invalid_argument(
        fmt::format("'{}' holds more than one value; expected a key of one: {}", varied.key, joined(known)));
  if (varied.law != VariedKey::Law::grid && key->type != Key::Type::number && key->type != Key::Type::whole)
    throw std::invalid_argument(
        fmt::format("'{}' draws numbers; expected {} between commas", varied.text, key->expected()));
  for (const filters::OptionValue& value : varied.values) check_value(*key, varied, value);
}

std::vector<std::string> keys_instead(const std::string& key) {
  const std::string path = path_in_file(key);
  const KeyTable* const section = find_key_table(path.substr(0, path.rfind('.')));
  return section == nullptr ? std::vector<std::string>() : section->rivals(path.substr(path.rfind('.') + 1));
}

}  // namespace beamid::experiments
