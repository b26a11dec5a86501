// beamid frame: natural frequencies and mode shapes of a plane frame.
#include <algorithm>
#include <filesystem>

#include "apps/deliver.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_frame.hpp"
#include "experiments/studies/continuum/frame_modes.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::apps {
namespace {

int whole_number(const options::variables_map& values, const std::string& option, int most) {
  const int number = values[option].as<int>();
  if (number < 1 || number > most)
    throw UsageError("frame: --" + option + " is " + std::to_string(number) +
                     "; expected a whole number from 1 to " + std::to_string(most));
  return number;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()                                                                           //
      ("modes", options::value<int>()->value_name("K")->default_value(10), "how many, the lowest")  //
      ("elements", options::value<int>()->value_name("N"),
       "finite elements of each member, instead of the file's");
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {"file"}, values)) return 0;
  if (!values.count("file")) throw UsageError("frame: which FILE? (docs/configuration.md, [frame])");
  constexpr int most_modes = 1000;
  const int count = whole_number(values, "modes", most_modes);
  const std::filesystem::path file = values["file"].as<std::string>();
  experiments::FrameExperiment experiment = experiments::read_frame(file);
  const auto members = static_cast<int>(experiment.frame.members.size());
  if (values.count("elements"))
    experiment.elements_per_member =
        whole_number(values, "elements", std::max(1, experiments::most_elements / members));
  deliver(values, [&] {
    return experiments::at_place({file.string()}, [&] {
      const auto found = experiments::frame_modes(experiment, count, show_progress());
      return experiments::report(experiment, found);
    });
  });
  return 0;
}

}  // namespace

Command frame_command() {
  return {"frame", "FILE [--modes K] [--elements N] [--out DIR]",
          "natural frequencies and mode shapes of a plane frame, with their errors",
          "  beamid frame portal.toml\n"
          "  beamid frame portal.toml --modes 5 --elements 40 --out results\n",
          run};
}

}  // namespace beamid::apps
