#include "apps/identify_request.hpp"

#include <algorithm>
#include <stdexcept>

#include "experiments/config/failure_response.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/damping_law/damping_law.hpp"
#include "experiments/text/spelling.hpp"
#include "filters/smoother.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

void refuse_what_needs_an_oscillator(const Experiment& experiment) {
  if (!experiment.smoother.empty())
    throw UsageError(std::string("identify: a smoother") + only_for_free_oscillators);
  if (experiment.estimator != "filter")
    throw UsageError("identify: estimator " + experiment.estimator + only_for_free_oscillators);
  if (experiment.noise_method.name != "residual")
    throw InputError(experiment.noise_method.place,
                     "noise.method " + experiment.noise_method.name + only_for_free_oscillators);
}

/// What the command line says in place of the experiment file.
void take_words(const options::variables_map& values, Experiment& experiment) {
  if (values.count("estimator")) {
    experiment.estimator = values["estimator"].as<std::string>();
    if (experiment.estimator != "filter" && experiment.estimator != "both")
      throw UsageError("identify: --estimator is '" + experiment.estimator + "'; expected filter or both");
  }
  try {
    if (values.count("on-failure"))
      experiment.on_failure = failure_response(values["on-failure"].as<std::string>());
    if (values.count("smoother")) experiment.smoother = values["smoother"].as<std::string>();
    if (!experiment.smoother.empty()) filters::smoother_registry().find(experiment.smoother);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("identify: ") + error.what());
  }
}

/// One pair of times of --window for all records, or one for each.
void take_window(const options::variables_map& values, std::size_t which, std::size_t records,
                 Experiment& experiment) {
  if (!values.count("window")) return;
  const auto& times = values["window"].as<std::vector<double>>();
  if (times.size() != 2 && times.size() != 2 * records)
    throw UsageError(records == 1 ? "identify: --window needs two times: FROM TO"
                                  : "identify: --window has " + std::to_string(times.size()) + " times for " +
                                        std::to_string(records) +
                                        " records; expected FROM TO once for all, or once for each");
  const std::size_t at = times.size() == 2 ? 0 : 2 * which;
  experiment.format.window = {times[at], times[at + 1]};
  experiment.format.window_place = {"--window"};
}

}  // namespace

options::options_description identify_options() {
  options::options_description described("Options");
  described.add_options()  //
      ("config", options::value<std::vector<std::string>>()->value_name("FILE"),
       "experiment file: beam, columns, units, window, filter (docs/configuration.md); repeated, one for "
       "each "
       "record: beams that share the [[parameters]] of one name, as lengths of one strip share its "
       "stiffness")  //
      ("window", options::value<std::vector<double>>()->multitoken()->value_name("FROM TO"),
       "part of the record to use [s], instead of the experiment file's; after RECORD; of several records, "
       "once for all or once for each; without any, the decay behind the last hit or release")  //
      ("on-failure", options::value<std::string>()->value_name("WHAT"),
       "when the filter fails: stop (default), inflate its covariance and go on, report and go on")  //
      ("smoother", options::value<std::string>()->value_name("NAME"),
       "rts or urts: what the whole record says of every instant, in smoothed.csv and a figure")  //
      ("estimator", options::value<std::string>()->value_name("WHICH"),
       "filter (default), or both: beside it the batch estimate, all samples at once")  //
      ("damping-law", options::value<std::string>()->value_name("LAW"),
       "auto, viscous, coulomb, quadratic or both: fit these laws to a free decay, with the evidence for "
       "each");
  return described;
}

/// What --damping-law asks for; empty: nothing.
std::string damping_law(const options::variables_map& values) {
  if (!values.count("damping-law")) return {};
  const std::string law = values["damping-law"].as<std::string>();
  const auto& laws = damping_laws();
  if (law != "auto" && std::find(laws.begin(), laws.end(), law) == laws.end())
    throw UsageError("identify: unknown damping law '" + law + "'; known: auto, " + joined(laws));
  for (const char* other : {"smoother", "estimator"})
    if (values.count(other))
      throw UsageError(std::string("identify: --damping-law fits all samples at once; expected no --") +
                       other);
  return law;
}

std::vector<IdentifyRequest> identify_requests(const options::variables_map& values, const fs::path& config) {
  Experiment experiment = read_experiment(config);
  take_words(values, experiment);
  std::vector<fs::path> files;
  if (values.count("record"))
    for (const std::string& file : values["record"].as<std::vector<std::string>>()) files.emplace_back(file);
  else if (experiment.record_file)
    files = {config.parent_path() / *experiment.record_file};
  else
    throw UsageError("identify: no RECORD on the command line, and no 'file' under [record] in " +
                     config.string());
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
    if (!one.is_free_oscillator()) refuse_what_needs_an_oscillator(one.experiment);
    requests.push_back(std::move(one));
  }
  return requests;
}

}  // namespace beamid::apps
