// beamid efficiency: filters against the Cramer-Rao bound, over seeded runs.
#include <fmt/format.h>

#include <cmath>

#include "apps/deliver.hpp"
#include "experiments/efficiency/report.hpp"
#include "experiments/input/choice_text.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

options::options_description efficiency_options() {
  options::options_description described("Options");
  described.add_options()  //
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
  for (const double ratio : settings.damping_ratios)
    if (!(ratio > 0.0 && ratio < 1.0))
      throw UsageError(
          fmt::format("efficiency: --damping-ratio is {:g}; expected a number between 0 and 1", ratio));
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
  settings.seed = static_cast<std::uint64_t>(whole(values, "seed", 0, 0x1p52));
  settings.decay.noise = values["noise"].as<double>();
  if (!(settings.decay.noise > 0.0 && settings.decay.noise <= 1.0))
    throw UsageError(fmt::format("efficiency: --noise is {:g}; expected a number above 0, 1 at most",
                                 settings.decay.noise));
  return settings;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described = efficiency_options();
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;
  const EfficiencySettings settings = settings_of(values);
  deliver(values, [&] { return report(find_efficiency(settings, show_progress())); });
  return 0;
}

}  // namespace

Command efficiency_command() {
  return {"efficiency",
          "[--filter NAME[:OPTION=VALUE,...]]... [--damping-ratio XI]... [--runs N] [--out DIR]",
          "filters against the Cramer-Rao bound, over seeded simulated decays",
          "  beamid efficiency --filter ekf --filter ukf\n"
          "  beamid efficiency --filter particle:particles=500 --damping-ratio 0.1 --sampled-runs 50\n"
          "  beamid efficiency --filter ekf --guess ends --noise 0.002 --passes single\n"
          "  beamid efficiency --runs 4000 --out results\n",
          run};
}

}  // namespace beamid::apps
