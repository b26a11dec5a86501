// beamid efficiency: filters against the Cramer-Rao bound, and intervals against the truth, over seeded runs.
#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/studies/efficiency/interval_coverage.hpp"
#include "experiments/studies/efficiency/laboratory_records.hpp"
#include "experiments/studies/efficiency/report.hpp"
#include "experiments/studies/efficiency/seeded_decays.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

constexpr double largest_seed = 0x1p52;

OptionGroup efficiency_options() {
  return {
      "Options",
      {text("study", "NAME",
            "filters: against the bound; coverage: how often the intervals of identify hold the truth, with "
            "higher modes and coloured noise (uses --runs, --seed, --noise and one --damping-ratio); decays: "
            "whether identify ends well on clean decays of all lengths and dampings (uses --runs, --seed); "
            "records: what identify makes of laboratory records with only the beam specified (uses "
            "--runs, of which 100 are enough, --seed and --only)")
           .one_of({"filters", "coverage", "decays", "records"})
           .by_default("filters"),
       text(
           "model", "NAME",
           "--study coverage: K and C of one degree of freedom, or the beam on one mode, on three, or on its "
           "mesh")
           .one_of({"sdof", "one_mode", "three_modes", "mesh"})
           .by_default("sdof"),
       whole("only", "N", 0, 1e5, "--study records: this record alone, from 0, with its files"),
       filter_option("one to examine; without any all but kf (beamid list filters)").repeated(),
       number("damping-ratio", "XI", "one to simulate; without any 0.0015, 0.01 and 0.1")
           .greater_than(0)
           .less_than(1)
           .repeated(),
       text("passes", "NAME", "lengthening: several over more and more of the record; single: one; both")
           .one_of({"lengthening", "single", "both"})
           .by_default("both"),
       text("guess", "NAME", "of K and C; drawn: from half to twice the truth; ends: half or twice")
           .one_of({"drawn", "ends"})
           .by_default("drawn"),
       whole("runs", "N", 1, 1e6, "seeded runs of each filter").by_default("2000"),
       whole("sampled-runs", "N", 2, 1e6, "of filters that draw samples (enkf, particle), which are slow")
           .by_default("100"),
       whole("seed", "N", 0, largest_seed, "of the first run").by_default("1"),
       number("noise", "SHARE", "standard deviation of the readings as a share of the amplitude")
           .greater_than(0)
           .up_to(1)
           .by_default("0.02")}};
}

std::uint64_t seed_of(const Values& values) {
  return static_cast<std::uint64_t>(values.number("seed"));
}

/// What the study of that name takes fewer of, or more, than the option allows.
int runs_of(const Values& values, int least, int most) {
  const int runs = values.whole("runs");
  if (runs < least || runs > most)
    throw UsageError(fmt::format("--runs is {}; expected a whole number from {} to {}", runs, least, most));
  return runs;
}

/// Options that a study with conditions of its own has no use for.
void refuse(const Values& values, const Words& others) {
  for (const std::string& other : others)
    if (values.has(other))
      throw UsageError(fmt::format("--study {} takes no --{}", values.text("study"), other));
}

CoverageSettings coverage_settings(const Values& values) {
  constexpr double largest = 0.1;  // of damping ratio and noise; beyond, a decay has no 30 cycles to show
  refuse(values, {"filter", "passes", "guess", "sampled-runs"});
  CoverageSettings settings;
  const std::vector<double> ratios = values.numbers("damping-ratio");
  if (ratios.size() > 1)
    throw UsageError(fmt::format("--study coverage takes one --damping-ratio; found {}", ratios.size()));
  if (!ratios.empty()) settings.damping_ratio = ratios[0];
  settings.runs = runs_of(values, 2, 1000000);
  settings.seed = seed_of(values);
  settings.noise = values.number("noise");
  settings.model = coverage_model(values.text("model"));
  for (const auto& [name, value] :
       {std::pair("damping-ratio", settings.damping_ratio), std::pair("noise", settings.noise)})
    if (value > largest)
      throw UsageError(
          fmt::format("--{} is {:g}; expected {:g} at most for --study coverage", name, value, largest));
  return settings;
}

/// --study decays: of all lengths and dampings, drawn.
SeededDecays decay_settings(const Values& values) {
  refuse(values, {"filter", "passes", "guess", "sampled-runs", "damping-ratio", "noise", "model"});
  SeededDecays settings;
  settings.runs = runs_of(values, 1, 1000000);
  settings.seed = seed_of(values);
  return settings;
}

/// --study records: a hundred of them unless --runs says another number.
LaboratorySettings laboratory_settings(const Values& values) {
  refuse(values, {"filter", "passes", "guess", "sampled-runs", "damping-ratio", "noise", "model"});
  LaboratorySettings settings;
  if (values.has("runs")) settings.records = runs_of(values, 1, 100000);
  settings.seed = seed_of(values);
  return settings;
}

EfficiencySettings efficiency_settings_of(const Values& values) {
  EfficiencySettings settings;
  for (const std::string& text : values.texts("filter"))
    settings.filters.push_back(parse_choice(text, "--filter", filters::filter_registry()));
  if (settings.filters.empty()) settings.filters = applicable_filters();
  if (values.has("damping-ratio")) settings.damping_ratios = values.numbers("damping-ratio");
  if (const std::string& passes = values.text("passes"); passes != "both")
    settings.passes = {passes == "single" ? Passes::single : Passes::lengthening};
  settings.decay.guess = values.text("guess") == "ends" ? Guess::ends : Guess::drawn;
  settings.runs = runs_of(values, 2, 1000000);
  settings.sampled_runs = values.whole("sampled-runs");
  settings.seed = seed_of(values);
  settings.decay.noise = values.number("noise");
  return settings;
}

int run_efficiency(const Values& values) {
  const std::string study = values.text("study");
  if (study == "coverage") {
    const CoverageSettings settings = coverage_settings(values);
    return deliver(values, [&] { return report(interval_coverage(settings, show_progress(values))); });
  }
  if (study == "decays") {
    const SeededDecays settings = decay_settings(values);
    return deliver(values, [&] { return report(seeded_decays(settings, show_progress(values))); });
  }
  if (study == "records") {
    const LaboratorySettings settings = laboratory_settings(values);
    const bool one = values.has("only");
    const int number = one ? values.whole("only") : 0;
    if (number >= settings.records)
      throw UsageError(
          fmt::format("--only is {}; expected a whole number from 0 to {}", number, settings.records - 1));
    return deliver(values, [&] {
      return one ? examine(settings, number) : report(laboratory_records(settings, show_progress(values)));
    });
  }
  if (values.has("only")) throw UsageError("--only goes with --study records");
  if (values.has("model")) throw UsageError("--model goes with --study coverage");
  const EfficiencySettings settings = efficiency_settings_of(values);
  return deliver(values, [&] { return report(find_efficiency(settings, show_progress(values))); });
}

}  // namespace

Command efficiency_command() {
  return {
      "efficiency",
      "[--study NAME] [--filter NAME[:OPTION=VALUE,...]]... [--damping-ratio XI]... [--runs N] [--out DIR]",
      "filters against the Cramer-Rao bound, and intervals against the truth, over seeded runs",
      {},
      {efficiency_options(), output_options()},
      "  beamid efficiency --filter ekf --filter ukf\n"
      "  beamid efficiency --filter particle:particles=500 --damping-ratio 0.1 --sampled-runs 50\n"
      "  beamid efficiency --filter ekf --guess ends --noise 0.002 --passes single\n"
      "  beamid efficiency --runs 4000 --out results\n"
      "  beamid efficiency --study coverage --runs 2000 --out intervals\n"
      "  beamid efficiency --study coverage --model three_modes --runs 500\n"
      "  beamid efficiency --study decays --runs 2000 --out decays\n"
      "  beamid efficiency --study records --out records\n"
      "  beamid efficiency --study records --only 7 --out record_7\n",
      run_efficiency};
}

}  // namespace beamid::apps
