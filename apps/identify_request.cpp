#include "apps/identify_request.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "apps/method_options.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/failure_response.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/damping_law/damping_law.hpp"
#include "experiments/text/spelling.hpp"
#include "filters/smoother.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

/// What the command line says in place of the experiment file.
void take_words(const Values& values, Experiment& experiment) {
  if (values.has("estimator")) experiment.estimator = values.text("estimator");
  if (values.has("smoother")) experiment.smoother = values.text("smoother");
  choose_failure_response(values, experiment);
}

/// One pair of times of --window for all records, or one for each.
void take_window(const Values& values, std::size_t which, std::size_t records, Experiment& experiment) {
  if (!values.has("window")) return;
  const std::vector<double> times = values.numbers("window");
  if (times.size() != 2 && times.size() != 2 * records)
    throw UsageError(records == 1 ? "--window needs two times: FROM TO"
                                  : "--window has " + std::to_string(times.size()) + " times for " +
                                        std::to_string(records) +
                                        " records; expected FROM TO once for all, or once for each");
  const std::size_t at = times.size() == 2 ? 0 : 2 * which;
  if (!(times[at] < times[at + 1]))
    throw UsageError(
        fmt::format("--window ends at {:g}, before its start at {:g}; expected the smaller number first",
                    times[at + 1], times[at]));
  experiment.format.window = {times[at], times[at + 1]};
  experiment.format.window_place = {"--window"};
}

}  // namespace

OptionGroup identify_options() {
  Words laws = damping_laws();
  laws.insert(laws.begin(), "auto");
  Option window =
      from_to("window",
              "part of the record to use [s], instead of the experiment file's; of several records, once "
              "for all or once for each; without any, the decay behind the last hit or release");
  return {"Options",
          {config_option(
               "experiment file: beam, columns, units, window, filter (docs/configuration.md); once for "
               "each record: beams that share the [[parameters]] of one name, as lengths of one strip "
               "share its stiffness")
               .repeated()
               .needed(),
           window.several().repeated(), on_failure_option(),
           smoother_option("what the whole record says of every instant, in smoothed.csv and a figure"),
           text("estimator", "WHICH", "filter, or both: beside it the batch estimate, all samples at once")
               .one_of({"filter", "both"})
               .by_default("filter"),
           text("damping-law", "LAW", "fit these laws to a free decay, with the evidence for each")
               .one_of(laws)}};
}

std::string damping_law(const Values& values) {
  const std::string& law = values.text("damping-law");
  if (law.empty()) return {};
  for (const char* other : {"smoother", "estimator"})
    if (values.has(other))
      throw UsageError(std::string("--damping-law fits all samples at once; expected no --") + other);
  return law;
}

std::vector<IdentifyRequest> identify_requests(const Values& values, const fs::path& config) {
  Experiment experiment = read_experiment(config);
  take_words(values, experiment);
  const std::vector<fs::path> files =
      require_record_files(values, config, experiment.record_file, experiment.format);
  std::vector<IdentifyRequest> requests;
  for (std::size_t r = 0; r < files.size(); ++r) {
    IdentifyRequest one{files[r], experiment, {}, {}};
    take_window(values, r, files.size(), one.experiment);
    one.prepared = read_and_prepare(one.file, one.experiment.format);
    try {
      cut_decay(one);
      if (damping_law(values).empty()) keep_out_higher_modes(one);
    } catch (const std::invalid_argument& error) {
      throw InputError({config.string()}, error.what());
    }
    requests.push_back(std::move(one));
  }
  return requests;
}

}  // namespace beamid::apps
