// beamid frf: frequency responses from point to point.
#include "apps/beam_options.hpp"
#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/studies/continuum/report.hpp"

namespace beamid::apps {
namespace {

const std::vector<KeyOption>& response_keys() {
  static const std::vector<KeyOption> keys{
      {number("from", "HZ", "first frequency [Hz]"), "frequency_response", "from_hz"},
      {number("to", "HZ", "last frequency [Hz]"), "frequency_response", "to_hz"},
      {text("kind", "KIND", "receptance, mobility or accelerance")
           .such_as({"receptance", "mobility", "accelerance"}),
       "frequency_response", "kind"}};
  return keys;
}

int run_frf(const Values& values) {
  const BeamSource source = read_beam(values, response_keys());
  return deliver(values, [&] {
    return blame_config(source, [&] {
      return experiments::report(
          source.experiment, experiments::respond_to_frequencies(source.experiment, show_progress(values)));
    });
  });
}

}  // namespace

Command frf_command() {
  return {"frf",
          "[--config FILE] [BEAM OPTIONS] [--out DIR]",
          "frequency responses of a beam from point to point, resonances and anti-resonances",
          {},
          {key_options(response_keys()), beam_options(), output_options()},
          "  beamid frf --damping-ratio 0.01\n"
          "  beamid frf --damping-ratio 0.01 --kind accelerance --from 1 --to 200 --out results\n"
          "  beamid frf --config rig.toml --out results\n",
          run_frf};
}

}  // namespace beamid::apps
