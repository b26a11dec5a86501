// beamid modes: natural frequencies and mode shapes, each with what tells how far to trust it.
#include "apps/beam_options.hpp"
#include "apps/deliver.hpp"
#include "experiments/studies/continuum/modal_report.hpp"

namespace beamid::apps {
namespace {

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()                                                                           //
      ("modes", options::value<int>()->value_name("K")->default_value(10), "how many, the lowest")  //
      ("surface", "draw the real sections in the meshes for ParaView");
  described.add(beam_options()).add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;
  constexpr int most_modes = 1000;
  const int count = values["modes"].as<int>();
  if (count < 1 || count > most_modes)
    throw UsageError("modes: --modes is " + std::to_string(count) + "; expected a whole number from 1 to " +
                     std::to_string(most_modes));
  const BeamSource source = read_beam(command, values);
  deliver(values, [&] {
    return blame_config(source, [&] {
      const auto summary = experiments::summarise_modes(source.experiment, count, show_progress());
      return experiments::report(source.experiment, summary, values.count("surface") > 0);
    });
  });
  return 0;
}

}  // namespace

Command modes_command() {
  return {"modes", "[--config FILE] [BEAM OPTIONS] [--modes K] [--out DIR]",
          "natural frequencies and mode shapes of a beam, with their errors",
          "  beamid modes\n"
          "  beamid modes --tip-mass 0.36 --axial-load 100 --modes 5\n"
          "  beamid modes --support clamped-clamped --diameter 0.02 --elements 200\n"
          "  beamid modes --config wing.toml --surface --out results\n",
          run};
}

}  // namespace beamid::apps
