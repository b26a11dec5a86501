#include "experiments/sweep/read_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/config/key_tables.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/choice_text.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
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
