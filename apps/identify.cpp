// beamid identify: a real record in, stiffness and damping with intervals out.
#include <filesystem>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "apps/identify_request.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/joint_comparison.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/studies/compare/report.hpp"
#include "experiments/studies/damping/report.hpp"
#include "experiments/studies/identify/report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/studies/twins/record_report.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

Comparison identified(const IdentifyRequest& one, const fs::path& folder, const Progress& progress) {
  return identify_with_model(one.experiment, one.compared(), folder, progress);
}

/// K and C of a free decay have a report of their own. @throws where no mode is near the beam's, or the model
/// has no motion
const RecordIdentification& oscillator_in(const Comparison& found) {
  if (!found.analysis.modal_refusal.empty()) throw std::invalid_argument(found.analysis.modal_refusal);
  const ComparedRun& run = found.runs.at(0);
  if (!run.oscillator) throw std::runtime_error("the filter cannot begin: " + run.reason);
  return *run.oscillator;
}

Results identify_one(const IdentifyRequest& one, const std::string& law, const fs::path& config,
                     const Progress& progress) {
  const Experiment& experiment = one.experiment;
  const fs::path folder = config.parent_path();
  if (law.empty() && !experiment.unknown_forces.empty()) {
    require_linear_storeys(experiment, "identify with [[unknown_forces]]");
    Results sensed = sensed_record(experiment, one.prepared, one.file, config, progress);
    sensed.command = "identify";
    return sensed;
  }
  if (!law.empty()) require_linear_storeys(experiment, "identify --damping-law");
  const Record& record = one.prepared.record;
  const std::string name = one.file.filename().string();
  Results results;
  if (!law.empty()) {
    results = report(experiment, record, name, study_damping_law(experiment, record, law, folder));
  } else {
    if (one.is_free_oscillator()) {
      const Comparison found = identified(one, folder, progress);
      results = report(experiment, found.compared.record, name, oscillator_in(found));
      add_clocks(results, found);
    } else {
      const LikeliestSet answer = likeliest_set(
          experiment, folder,
          [&](const Experiment& started) {
            return identify_with_model(started, one.compared(), folder, progress);
          },
          progress);
      results = identification_report(experiment, answer.found);
      if (!answer.exchanged.empty()) results.paragraph(answer.exchanged);
      add_twins(results, answer.found.runs.at(0), answer.twins);
    }
  }
  for (const std::string& text : one.decisions()) results.paragraph(text);
  add_preparation(results, one.as_analysed(), experiment.format);
  return results;
}

void refuse_what_needs_one_record(const std::vector<IdentifyRequest>& requests) {
  const Experiment& experiment = requests[0].experiment;
  if (!experiment.smoother.empty()) throw UsageError("a smoother takes one RECORD");
  if (experiment.estimator != "filter")
    throw UsageError("estimator " + experiment.estimator + " takes one RECORD");
}

/// Every record's damping law, and whether one holds for all.
Results laws_of(const std::vector<IdentifyRequest>& requests, const std::string& law,
                const fs::path& folder) {
  require_linear_storeys(requests[0].experiment, "identify --damping-law");
  std::vector<StudiedRecord> studied;
  for (const IdentifyRequest& one : requests) {
    const Record& record = one.prepared.record;
    try {
      studied.push_back(
          {one.file.filename().string(), record, study_damping_law(one.experiment, record, law, folder)});
    } catch (const std::invalid_argument& error) {
      throw InputError({one.file.string()}, error.what());
    }
  }
  return report(requests[0].experiment, studied);
}

std::vector<Comparison> identified(const std::vector<IdentifyRequest>& requests, const fs::path& folder,
                                   const Progress& progress) {
  std::vector<Comparison> found;
  for (const IdentifyRequest& one : requests) {
    progress("identifying " + one.file.filename().string());
    try {
      found.push_back(identified(one, folder, progress));
      if (one.is_free_oscillator()) oscillator_in(found.back());
    } catch (const std::invalid_argument& error) {
      throw InputError({one.file.string()}, error.what());
    }
  }
  return found;
}

JointIdentification oscillators(const std::vector<Comparison>& found) {
  std::vector<IdentifiedRecord> records;
  for (const Comparison& one : found)
    records.push_back({one.compared.name, one.compared.record, oscillator_in(one)});
  return joint_identification(std::move(records));
}

Results identify_together(const std::vector<IdentifyRequest>& requests, const std::string& law,
                          const fs::path& folder, const Progress& progress) {
  bool free = true;
  for (const IdentifyRequest& one : requests) free = free && one.is_free_oscillator();
  Results results;
  if (!law.empty()) {
    results = laws_of(requests, law, folder);
  } else {
    std::vector<Comparison> found = identified(requests, folder, progress);
    results = free ? report(requests[0].experiment, oscillators(found))
                   : report(requests[0].experiment, joint_comparison(std::move(found)));
  }
  for (const IdentifyRequest& one : requests)
    for (const std::string& text : one.decisions())
      results.paragraph(one.file.filename().string() + ": " + text);
  for (const IdentifyRequest& one : requests)
    add_cost(results, one.file.filename().string(), one.as_analysed(), one.experiment.format);
  return results;
}

int run_identify(const Values& values) {
  const Words configs = values.texts("config");
  if (configs.size() > 1) {
    return deliver(values, [&] {
      try {
        return identify_family(values, {configs.begin(), configs.end()});
      } catch (const std::invalid_argument& error) {
        throw InputError({configs[0]}, error.what());
      }
    });
  }
  const fs::path config = configs.empty() ? fs::path() : fs::path(configs[0]);
  const std::string law = damping_law(values);
  const std::vector<IdentifyRequest> requests = identify_requests(values, config);
  if (requests.size() > 1) refuse_what_needs_one_record(requests);
  const Progress progress = show_progress(values);
  return deliver(values, [&] {
    try {
      Results results = requests.size() > 1 ? identify_together(requests, law, config.parent_path(), progress)
                                            : identify_one(requests[0], law, config, progress);
      warn(results, requests[0].experiment);
      return results;
    } catch (const std::invalid_argument& error) {
      throw InputError({config.empty() ? requests[0].file.string() : config.string()}, error.what());
    }
  });
}

}  // namespace

Command identify_command() {
  return {
      "identify",
      "[RECORD...] [--config FILE] [--window FROM TO]... [--out DIR]",
      "stiffness, damping, frequency and damping ratio from vibration records",
      {record_argument(true)},
      {identify_options(), column_options(), output_options()},
      "  beamid identify phone.csv\n"
      "  beamid identify phone.csv --mass 2.5\n"
      "  beamid identify tip_acceleration.csv --config cantilever.toml --out results\n"
      "  beamid identify --config cantilever.toml --window 0.8 1.6\n"
      "  beamid identify run1.csv run2.csv run3.csv --config cantilever.toml --out together\n"
      "  beamid identify run1.csv run2.csv --config cantilever.toml --window 0.8 1.6 0.5 2.1\n"
      "  beamid identify --config cantilever.toml --estimator both\n"
      "  beamid identify --config cantilever.toml --on-failure inflate --smoother rts --out results\n"
      "  beamid identify --config cantilever.toml --damping-law auto --out results\n"
      "  beamid identify hard.csv soft.csv --config cantilever.toml --damping-law auto\n"
      "  logger | beamid identify - --config cantilever.toml\n",
      run_identify,
      "",
      "3  no estimate to rely on, and \"status\" in results.json states which: the filter \"diverged\", or "
      "the modal "
      "analysis \"contradicted\" it, with less than half or more than twice the damping. The first lines "
      "state why.\n"};
}

}  // namespace beamid::apps
