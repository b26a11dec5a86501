// beamid frame: natural frequencies and mode shapes of a plane frame.
#include <filesystem>

#include "apps/beam_options.hpp"
#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/studies/continuum/report.hpp"

namespace beamid::apps {
namespace {

using experiments::TomlTable;

int run_frame(const Values& values) {
  const std::filesystem::path file = values.texts("file")[0];
  if (const TomlTable described = TomlTable::read(file); !described.contains("frame"))
    throw experiments::InputError(
        described.place(), "no [frame]; expected a plane frame (modes --config FILE takes any structure)");
  std::vector<experiments::Override> overrides;
  if (values.has("elements"))
    overrides.push_back({"frame", "elements_per_member", 1.0 * values.whole("elements"), "--elements"});
  const BeamSource source{experiments::read_experiment(file, overrides), file};
  return deliver(values, [&] {
    return blame_config(source, [&] {
      experiments::Results results =
          experiments::modes_study(source.experiment, values.whole("modes"), false, show_progress(values));
      results.command = "frame";
      return results;
    });
  });
}

}  // namespace

Command frame_command() {
  return {"frame",
          "FILE [--modes K] [--elements N] [--out DIR]",
          "natural frequencies and mode shapes of a plane frame, with their errors",
          {{.name = "file", .required = true, .hint = "(docs/configuration.md, [frame])"}},
          {{"Options",
            {whole("modes", "K", 1, 1000, "how many, the lowest").by_default("10"),
             whole("elements", "N", 1, experiments::most_elements,
                   "finite elements of each member, instead of the file's")}},
           output_options()},
          "  beamid frame portal.toml\n"
          "  beamid frame portal.toml --modes 5 --elements 40 --out results\n",
          run_frame};
}

}  // namespace beamid::apps
