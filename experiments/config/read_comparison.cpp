#include "experiments/config/read_comparison.hpp"

#include "experiments/text/method_choice.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"

namespace beamid::experiments {

void read_comparison(const TomlTable& root, Experiment& experiment) {
  for (const TomlTable& table : root.find_tables("filters")) {
    experiment.filters.push_back(read_choice(table, "method", "ekf", filters::filter_registry()));
    if (!table.contains("method")) table.miss("method", "a name from `beamid list filters`");
  }
  const auto compare = root.find_table("compare");
  if (!compare) return;
  constexpr int most_passes = 20;
  experiment.passes = compare->find_whole_number("passes", 1, most_passes).value_or(experiment.passes);
  const Place place = compare->value_place("discretisations");
  experiment.discretisations = compare->find_texts("discretisations").value_or(experiment.discretisations);
  for (const std::string& name : experiment.discretisations)
    at_place(place, [&] { filters::scheme_registry().find(name); });
}

}  // namespace beamid::experiments
