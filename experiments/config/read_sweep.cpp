#include "experiments/config/read_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/config/known_names.hpp"
#include "experiments/config/vocabulary.hpp"
#include "experiments/text/method_choice.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

SweepPlan read_sweep(const TomlTable& table) {
  SweepPlan plan;
  const auto texts = table.find_texts("vary");
  at_place(table.value_place("vary"), [&] {
    for (const std::string& text : texts.value_or(std::vector<std::string>())) {
      plan.varied.push_back(parse_varied(text));
      refuse_unknown(plan.varied.back());
    }
  });
  plan.samples = table.find_whole_number("random", 1, most_samples).value_or(plan.samples);
  plan.seeds = table.find_whole_number("seeds", 1, most_samples).value_or(plan.seeds);
  constexpr int largest_seed = 2000000000;
  plan.seed = static_cast<std::uint64_t>(table.find_whole_number("seed", 0, largest_seed).value_or(1));
  plan.once = table.find_text("identify", {"compare", "once"}).value_or("compare") == "once";
  at_place(table.place(), [&] { check(plan); });
  return plan;
}

void refuse_unknown(const VariedKey& varied) {
  const std::size_t start = varied.key.starts_with("truth.") ? std::string("truth.").size() : 0;
  const std::size_t dot = varied.key.rfind('.');
  std::string table, key = varied.key.substr(dot + 1);
  bool within = false;  // of the brackets of "sensors[1]"
  for (std::size_t i = start; i < dot; ++i) {
    within = within || varied.key[i] == '[';
    if (!within) table += varied.key[i];
    if (varied.key[i] == ']') within = false;
  }
  if (within)
    throw std::invalid_argument(
        fmt::format("'{}' has a bracket that is not closed; expected as sensors[1].noise_m", varied.key));
  const auto known = std::find_if(vocabulary().begin(), vocabulary().end(),
                                  [&](const TableVocabulary& one) { return one.table == table; });
  if (known == vocabulary().end() || table.empty() || table == "frame" || table == "sweep")
    throw std::invalid_argument(fmt::format("'{}' is in no table of an experiment file", varied.key));
  if (known->has_options) return;  // its method knows them
  if (std::find(known->keys.begin(), known->keys.end(), key) != known->keys.end()) return;
  throw std::invalid_argument(
      fmt::format("unknown key '{}' in {}; {}", key, table, known_names(key, known->keys)));
}

}  // namespace beamid::experiments
