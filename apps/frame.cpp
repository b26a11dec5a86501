// beamid frame: natural frequencies and mode shapes of a plane frame.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/command.hpp"
#include "apps/deliver.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_frame.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/studies/continuum/frame_modes.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::apps {
namespace {

int run_frame(const Values& values) {
  const std::filesystem::path file = values.texts("file")[0];
  experiments::FrameExperiment experiment = experiments::read_frame(file);
  const auto members = static_cast<int>(experiment.frame.members.size());
  if (values.has("elements")) {
    const int most = std::max(1, experiments::most_elements / members);
    experiment.elements_per_member = values.whole("elements");
    if (experiment.elements_per_member > most)
      throw UsageError(fmt::format("--elements is {}; expected a whole number from 1 to {}",
                                   experiment.elements_per_member, most));
  }
  return deliver(values, [&] {
    return experiments::at_place({file.string()}, [&] {
      const auto found = experiments::frame_modes(experiment, values.whole("modes"), show_progress(values));
      experiments::Results results = experiments::report(experiment, found);
      experiments::warn(results, experiment);
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
