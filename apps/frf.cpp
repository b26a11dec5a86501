// beamid frf: frequency responses from point to point.
#include "apps/beam_options.hpp"
#include "apps/deliver.hpp"
#include "experiments/studies/continuum/frequency_response_report.hpp"

namespace beamid::apps {
namespace {

const std::vector<KeyOption>& response_keys() {
  static const std::vector<KeyOption> keys{
      {"from", "frequency_response", "from_hz", {}, "HZ", "first frequency [Hz]"},
      {"to", "frequency_response", "to_hz", {}, "HZ", "last frequency [Hz]"},
      {"kind", "frequency_response", "kind", {}, "KIND", "receptance, mobility or accelerance", true}};
  return keys;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  describe(response_keys(), described);
  described.add(beam_options()).add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;
  const BeamSource source = read_beam(command, values, response_keys());
  deliver(values, [&] {
    return blame_config(source, [&] {
      return experiments::report(source.experiment,
                                 experiments::respond_to_frequencies(source.experiment, show_progress()));
    });
  });
  return 0;
}

}  // namespace

Command frf_command() {
  return {"frf", "[--config FILE] [BEAM OPTIONS] [--out DIR]",
          "frequency responses of a beam from point to point, resonances and anti-resonances",
          "  beamid frf --damping-ratio 0.01\n"
          "  beamid frf --damping-ratio 0.01 --kind accelerance --from 1 --to 200 --out results\n"
          "  beamid frf --config rig.toml --out results\n",
          run};
}

}  // namespace beamid::apps
