// beamid efficiency: filters against the Cramer-Rao bound, and intervals against the truth, over seeded runs.
#include <fmt/format.h>

#include <cmath>

#include "apps/deliver.hpp"
#include "experiments/studies/efficiency/interval_coverage.hpp"
#include "experiments/studies/efficiency/laboratory_records.hpp"
#include "experiments/studies/efficiency/report.hpp"
#include "experiments/studies/efficiency/seeded_decays.hpp"
#include "experiments/text/choice_text.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

options::options_description efficiency_options() {
  options::options_description described("Options");
  described.add_options()  //
      ("study", options::value<std::string>()->value_name("NAME")->default_value("filters"),
       "filters: against the bound; coverage: how often the intervals of identify hold the truth, with "
       "higher modes and coloured noise (uses --runs, --seed, --noise and one --damping-ratio); decays: "
       "whether identify ends well on clean decays of all lengths and dampings (uses --runs, --seed); "
       "records: what identify makes of laboratory records when given nothing but the beam (uses --runs "
       "[100], --seed and --only)")  //
      ("only", options::value<double>()->value_name("N"),
       "--study records: this record alone, from 0, with its files")  //
      ("filter",
       options::value<std::vector<std::string>>()->composing()->value_name("NAME[:OPTION=VALUE,...]"),
       "one to examine; may be given again and again [all but kf] (beamid list filters)")  //
      ("damping-ratio", options::value<std::vector<double>>()->composing()->value_name("XI"),
       "one to simulate; may be given again and again [0.0015, 0.01, 0.1]")  //
      ("passes", options::value<std::string>()->value_name("NAME")->default_value("both"),
       "lengthening: several over more and more of the record; single: one; both")  //
      ("guess", options::value<std::string>()->value_name("NAME")->default_value("drawn"),
       "of K and C; drawn: from half to twice the truth; ends: half or twice")  //
      ("runs", options::value<double>()->value_name("N")->default_value(2000), "seeded runs of each filter")(
          "sampled-runs", options::value<double>()->value_name("N")->default_value(100),
          "of filters that draw samples (enkf, particle), which are slow")                       //
      ("seed", options::value<double>()->value_name("N")->default_value(1), "of the first run")  //
      ("noise", options::value<double>()->value_name("SHARE")->default_value(0.02, "0.02"),
       "deviation of the readings as a share of the amplitude");
  return described;
}

double whole(const options::variables_map& values, const char* name, double least, double most) {
  const double value = values[name].as<double>();
  if (!(value >= least && value <= most && value == std::floor(value)))
    throw UsageError(fmt::format("efficiency: --{} is {:g}; expected a whole number from {:g} to {:g}", name,
                                 value, least, most));
  return value;
}

std::uint64_t seed_of(const options::variables_map& values) {
  return static_cast<std::uint64_t>(whole(values, "seed", 0, 0x1p52));
}

double noise_of(const options::variables_map& values) {
  const double noise = values["noise"].as<double>();
  if (!(noise > 0.0 && noise <= 1.0))
    throw UsageError(fmt::format("efficiency: --noise is {:g}; expected a number above 0, 1 at most", noise));
  return noise;
}

void check_ratios(const std::vector<double>& ratios, double most) {
  for (const double ratio : ratios)
    if (!(ratio > 0.0 && ratio < most))
      throw UsageError(fmt::format(
          "efficiency: --damping-ratio is {:g}; expected a number between 0 and {:g}", ratio, most));
}

CoverageSettings coverage_settings(const options::variables_map& values) {
  constexpr double largest_ratio = 0.1, largest_noise = 0.1;  // beyond, a decay has no 30 cycles to show
  for (const char* other : {"filter", "passes", "guess", "sampled-runs"})
    if (values.count(other) && !values[other].defaulted())
      throw UsageError(std::string("efficiency: --study coverage takes no --") + other);
  CoverageSettings settings;
  if (values.count("damping-ratio")) {
    const auto ratios = values["damping-ratio"].as<std::vector<double>>();
    check_ratios(ratios, largest_ratio);
    if (ratios.size() != 1)
      throw UsageError(
          fmt::format("efficiency: --study coverage takes one --damping-ratio; found {}", ratios.size()));
    settings.damping_ratio = ratios[0];
  }
  settings.runs = static_cast<int>(whole(values, "runs", 2, 1e6));
  settings.seed = seed_of(values);
  settings.noise = noise_of(values);
  if (settings.noise > largest_noise)
    throw UsageError(fmt::format("efficiency: --noise is {:g}; expected {:g} at most for --study coverage",
                                 settings.noise, largest_noise));
  return settings;
}

/// Options that a study with conditions of its own has no use for.
void refuse_conditions(const options::variables_map& values, const char* study) {
  for (const char* other : {"filter", "passes", "guess", "sampled-runs", "damping-ratio", "noise"})
    if (values.count(other) && !values[other].defaulted())
      throw UsageError(std::string("efficiency: --study ") + study + " takes no --" + other);
}

/// --study decays: of all lengths and dampings, drawn.
SeededDecays decay_settings(const options::variables_map& values) {
  refuse_conditions(values, "decays");
  SeededDecays settings;
  settings.runs = static_cast<int>(whole(values, "runs", 1, 1e6));
  settings.seed = seed_of(values);
  return settings;
}

/// --study records: a hundred of them unless --runs says another number.
LaboratorySettings laboratory_settings(const options::variables_map& values) {
  refuse_conditions(values, "records");
  LaboratorySettings settings;
  if (!values["runs"].defaulted()) settings.records = static_cast<int>(whole(values, "runs", 1, 1e5));
  settings.seed = seed_of(values);
  return settings;
}

EfficiencySettings settings_of(const options::variables_map& values) {
  EfficiencySettings settings;
  if (values.count("filter")) {
    for (const std::string& text : values["filter"].as<std::vector<std::string>>())
      settings.filters.push_back(parse_choice(text, "--filter", filters::filter_registry()));
  } else {
    settings.filters = applicable_filters();
  }
  if (values.count("damping-ratio"))
    settings.damping_ratios = values["damping-ratio"].as<std::vector<double>>();
  check_ratios(settings.damping_ratios, 1.0);
  const std::string passes = values["passes"].as<std::string>(), guess = values["guess"].as<std::string>();
  if (passes == "lengthening" || passes == "single")
    settings.passes = {passes == "single" ? Passes::single : Passes::lengthening};
  else if (passes != "both")
    throw UsageError("efficiency: --passes is '" + passes + "'; expected lengthening, single or both");
  if (guess != "drawn" && guess != "ends")
    throw UsageError("efficiency: --guess is '" + guess + "'; expected drawn or ends");
  settings.decay.guess = guess == "ends" ? Guess::ends : Guess::drawn;
  settings.runs = static_cast<int>(whole(values, "runs", 2, 1e6));
  settings.sampled_runs = static_cast<int>(whole(values, "sampled-runs", 2, 1e6));
  settings.seed = seed_of(values);
  settings.decay.noise = noise_of(values);
  return settings;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described = efficiency_options();
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;
  const std::string study = values["study"].as<std::string>();
  if (study == "coverage") {
    const CoverageSettings settings = coverage_settings(values);
    deliver(values, [&] { return report(interval_coverage(settings, show_progress())); });
    return 0;
  }
  if (study == "decays") {
    const SeededDecays settings = decay_settings(values);
    deliver(values, [&] { return report(seeded_decays(settings, show_progress())); });
    return 0;
  }
  if (study == "records") {
    const LaboratorySettings settings = laboratory_settings(values);
    const bool one = values.count("only") > 0;
    const int number = one ? static_cast<int>(whole(values, "only", 0, settings.records - 1)) : 0;
    deliver(values, [&] {
      return one ? examine(settings, number) : report(laboratory_records(settings, show_progress()));
    });
    return 0;
  }
  if (study != "filters")
    throw UsageError("efficiency: --study is '" + study + "'; expected filters, coverage, decays or records");
  if (values.count("only")) throw UsageError("efficiency: --only goes with --study records");
  const EfficiencySettings settings = settings_of(values);
  deliver(values, [&] { return report(find_efficiency(settings, show_progress())); });
  return 0;
}

}  // namespace

Command efficiency_command() {
  return {
      "efficiency",
      "[--study NAME] [--filter NAME[:OPTION=VALUE,...]]... [--damping-ratio XI]... [--runs N] [--out DIR]",
      "filters against the Cramer-Rao bound, and intervals against the truth, over seeded runs",
      "  beamid efficiency --filter ekf --filter ukf\n"
      "  beamid efficiency --filter particle:particles=500 --damping-ratio 0.1 --sampled-runs 50\n"
      "  beamid efficiency --filter ekf --guess ends --noise 0.002 --passes single\n"
      "  beamid efficiency --runs 4000 --out results\n"
      "  beamid efficiency --study coverage --runs 2000 --out intervals\n"
      "  beamid efficiency --study decays --runs 2000 --out decays\n"
      "  beamid efficiency --study records --out records\n"
      "  beamid efficiency --study records --only 7 --out record_7\n",
      run};
}

}  // namespace beamid::apps
