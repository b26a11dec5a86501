// beamid reduce: what each way to fewer coordinates keeps of a beam.
#include <fmt/format.h>

#include <filesystem>

#include "apps/beam_options.hpp"
#include "apps/deliver.hpp"
#include "experiments/config/read_reduction.hpp"
#include "experiments/studies/reduce/chosen_reductions.hpp"
#include "experiments/studies/reduce/report.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

options::options_description reduce_options() {
  options::options_description described("Options");
  described.add_options()  //
      ("reduction",
       options::value<std::vector<std::string>>()->composing()->value_name("NAME[:OPTION=VALUE,...]"),
       "one to compare; may be given again and again; numbers of a list are parted by '/' "
       "(beamid list reductions)")  //
      ("shape-file", options::value<std::string>()->value_name("FILE"),
       "position_m and deflection in two columns, for rayleigh:shape=given")  //
      ("modes", options::value<int>()->value_name("K")->default_value(5),
       "how many to compare, the lowest")  //
      ("band", options::value<double>()->value_name("TIMES")->default_value(20.0, "20"),
       "frequency responses are compared up to so many times the first frequency");
  return described;
}

ReductionComparisonSettings settings_of(const options::variables_map& values) {
  constexpr int most_modes = 100;
  ReductionComparisonSettings settings{values["modes"].as<int>(), values["band"].as<double>()};
  if (settings.modes < 1 || settings.modes > most_modes)
    throw UsageError(fmt::format("reduce: --modes is {}; expected a whole number from 1 to {}",
                                 settings.modes, most_modes));
  if (!(settings.band > 1.0 && settings.band <= 1000.0))
    throw UsageError(
        fmt::format("reduce: --band is {:g}; expected a number above 1, 1000 at most", settings.band));
  return settings;
}

// From the options, or the file's [[reductions]], or its [reduction], or one of each kind.
std::vector<Choice> chosen(const BeamSource& source, const options::variables_map& values) {
  const Experiment& experiment = source.experiment;
  std::vector<Choice> choices;
  if (values.count("reduction")) {
    for (const std::string& text : values["reduction"].as<std::vector<std::string>>())
      choices.push_back(parse_reduction(text, "--reduction"));
  } else if (!experiment.reductions.empty()) {
    choices = experiment.reductions;
  } else if (experiment.reduction.place.line > 0) {  // the file has the table
    choices = {experiment.reduction};
  } else {
    choices = default_reductions(experiment.beam);
    if (values.count("shape-file"))
      choices.insert(choices.begin(), parse_reduction("rayleigh:shape=given", "--shape-file"));
  }
  if (!values.count("shape-file")) return choices;
  std::filesystem::path file = values["shape-file"].as<std::string>();
  if (!source.config.parent_path().empty()) file = std::filesystem::absolute(file);  // not beside the config
  bool used = false;
  for (Choice& choice : choices)
    if (takes_shape(choice) && choice.shape_file.empty()) choice.shape_file = file.string(), used = true;
  if (!used)
    throw UsageError(
        "reduce: --shape-file has no use: no reduction waits for a shape; expected --reduction "
        "rayleigh:shape=given");
  return choices;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described = reduce_options();
  described.add(beam_options()).add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;
  const ReductionComparisonSettings settings = settings_of(values);
  const BeamSource source = read_beam(command, values);
  const std::vector<Choice> choices = chosen(source, values);
  deliver(values, [&] {
    return blame_config(source, [&] {
      return report(source.experiment,
                    std::make_shared<const ReductionComparison>(compare_reductions(
                        source.experiment, choices, settings, source.config.parent_path(), show_progress())));
    });
  });
  return 0;
}

}  // namespace

Command reduce_command() {
  return {"reduce", "[--reduction NAME[:OPTION=VALUE,...]]... [--config FILE] [BEAM OPTIONS] [--out DIR]",
          "reductions of a beam against its mesh: frequencies, shapes, responses, cost",
          "  beamid reduce\n"
          "  beamid reduce --tip-mass 0.0198575 --reduction rayleigh --reduction modal_truncation:modes=3\n"
          "  beamid reduce --reduction guyan:masters_m=0.4/0.8/1.1 --elements 200 --modes 8 --out results\n"
          "  beamid reduce --config rig.toml --reduction rayleigh:shape=given --shape-file shape.csv\n",
          run};
}

}  // namespace beamid::apps
