// beamid reduce: what each way to fewer coordinates keeps of a beam.
#include <filesystem>

#include "apps/beam_options.hpp"
#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/studies/reduce/report.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

OptionGroup reduce_options() {
  return {"Options",
          {reduction_option("one to compare; numbers of a list are parted by '/' (beamid list reductions)")
               .repeated(),
           text("shape-file", "FILE", "position_m and deflection in two columns, for rayleigh:shape=given"),
           whole("modes", "K", 1, 100, "how many to compare, the lowest").by_default("5"),
           number("band", "TIMES", "frequency responses are compared up to so many times the first frequency")
               .greater_than(1)
               .up_to(1000)
               .by_default("20")}};
}

// From the options, or the file's [[reductions]], or its [reduction], or one of each kind.
std::vector<Choice> chosen(const BeamSource& source, const Values& values) {
  const Experiment& experiment = source.experiment;
  std::vector<Choice> choices;
  if (values.has("reduction")) {
    for (const std::string& text : values.texts("reduction"))
      choices.push_back(parse_reduction(text, "--reduction"));
  } else if (!experiment.reductions.empty()) {
    choices = experiment.reductions;
  } else if (experiment.reduction.place.line > 0) {  // the file has the table
    choices = {experiment.reduction};
  } else {
    choices = default_reductions(experiment.structure);
    if (values.has("shape-file"))
      choices.insert(choices.begin(), parse_reduction("rayleigh:shape=given", "--shape-file"));
  }
  if (!values.has("shape-file")) return choices;
  std::filesystem::path file = values.text("shape-file");
  if (!source.config.parent_path().empty()) file = std::filesystem::absolute(file);  // not beside the config
  bool used = false;
  for (Choice& choice : choices)
    if (takes_shape(choice) && choice.shape_file.empty()) choice.shape_file = file.string(), used = true;
  if (!used)
    throw UsageError(
        "--shape-file has no use: no reduction waits for a shape; expected --reduction "
        "rayleigh:shape=given");
  return choices;
}

int run_reduce(const Values& values) {
  const ReductionComparisonSettings settings{values.whole("modes"), values.number("band")};
  const BeamSource source = read_beam(values);
  require_linear_storeys(source.experiment, "reduce");
  const std::vector<Choice> choices = chosen(source, values);
  return deliver(values, [&] {
    return blame_config(source, [&] {
      return report(source.experiment, std::make_shared<const ReductionComparison>(compare_reductions(
                                           source.experiment, choices, settings, source.config.parent_path(),
                                           show_progress(values))));
    });
  });
}

}  // namespace

Command reduce_command() {
  return {"reduce",
          "[--reduction NAME[:OPTION=VALUE,...]]... [--config FILE] [BEAM OPTIONS] [--out DIR]",
          "reductions of a beam against its mesh: frequencies, shapes, responses, cost",
          {},
          {reduce_options(), beam_options(), output_options()},
          "  beamid reduce\n"
          "  beamid reduce --tip-mass 0.0198575 --reduction rayleigh --reduction modal_truncation:modes=3\n"
          "  beamid reduce --reduction guyan:masters_m=0.4/0.8/1.1 --elements 200 --modes 8 --out results\n"
          "  beamid reduce --config rig.toml --reduction rayleigh:shape=given --shape-file shape.csv\n",
          run_reduce};
}

}  // namespace beamid::apps
