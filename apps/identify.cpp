// beamid identify: a real record in, stiffness and damping with intervals out.
#include <filesystem>

#include "apps/command.hpp"
#include "apps/deliver.hpp"
#include "apps/identify_family.hpp"
#include "apps/identify_request.hpp"
#include "apps/record_options.hpp"
#include "experiments/config/failure_response.hpp"
#include "experiments/identify/compare/comparison.hpp"
#include "experiments/identify/compare/run_verdict.hpp"
#include "experiments/identify/joint_comparison.hpp"
#include "experiments/identify/joint_identification.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/noise_source.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/identify/record_identification.hpp"
#include "experiments/identify/run_diagnostics.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/studies/compare/comparison_report.hpp"
#include "experiments/studies/damping/compared_laws.hpp"
#include "experiments/studies/identify/diagnostics_report.hpp"
#include "experiments/studies/identify/joint_comparison_report.hpp"
#include "experiments/studies/identify/joint_report.hpp"
#include "experiments/studies/identify/record_report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

constexpr const char* higher_modes =
    "Higher modes are a large part of this record. A filter of one mode would take them for white noise: the "
    "record was low-passed and decimated first, which changes neither frequency nor damping. Any "
    "[[record.prepare]] of the experiment file takes the place of this.";
constexpr const char* trouble = "The filter had trouble (--on-failure says what it then does). ";

/// Any other model than K and C of a free decay: a comparison of one run.
Comparison identify_by_comparison(Experiment experiment, const Record& record, const fs::path& file,
                                  const fs::path& folder, const Progress& progress) {
  experiment.reductions = {experiment.reduction};
  experiment.filters = {experiment.filter};
  experiment.discretisations = {experiment.discretisation};
  Comparison found = compare(experiment, measured_record(file.filename().string(), record), folder, progress);
  judge_runs(found);
  return found;
}

Results identify_generally(const Experiment& experiment, const Record& record, const fs::path& file,
                           const fs::path& folder, const Progress& progress) {
  const Comparison found = identify_by_comparison(experiment, record, file, folder, progress);
  Results results = report(experiment, found);
  results.command = "identify";
  results.values["status"] = to_string(found.runs.at(0).status);
  results.configuration["on_failure"] = to_string(experiment.on_failure);
  for (const ComparedRun& one : found.runs) {
    if (const std::string text = failure_sentences(one.run.events); !text.empty())
      results.paragraph(trouble + text);
    if (!one.diagnostics) continue;
    std::vector<std::string> outputs;
    for (const Eigen::Index i : output_channels(record)) outputs.push_back(record.channels[i].name);
    results.paragraph(words(*one.diagnostics, outputs));
    for (Figure& figure : figures(*one.diagnostics, outputs)) results.figures.push_back(std::move(figure));
  }
  return results;
}

/// With what the modal analysis beside the filter needed of the record: the filter takes it as it is.
PreparedRecord told_of(const IdentifyRequest& one) {
  PreparedRecord prepared = one.prepared;
  if (!one.is_free_oscillator()) {
    prepared.record = made_analysable(prepared.record);
  } else if (const std::string remark = analysable(prepared.record).remark; !remark.empty()) {
    prepared.record.remarks.push_back("For the modal analysis: " + remark);
  }
  return prepared;
}

/// Of the whole record behind its preparation, where the experiment wants it.
Eigen::VectorXd quiet_noise(const Experiment& experiment, const PreparedRecord& prepared) {
  if (experiment.noise_method.name != "before_event") return {};
  try {
    return noise_before_event(prepare(prepared.raw, experiment.format.preparation));
  } catch (const std::invalid_argument& error) {
    throw InputError(experiment.noise_method.place, error.what());
  }
}

Results identify_one(const IdentifyRequest& one, const std::string& law, const fs::path& folder,
                     const Progress& progress) {
  const Experiment& experiment = one.experiment;
  const Record& record = one.prepared.record;
  const std::string name = one.file.filename().string();
  Results results = !law.empty()
                        ? report(experiment, record, name, study_damping_law(experiment, record, law, folder))
                    : one.is_free_oscillator()
                        ? report(experiment, record, name,
                                 identify_record(experiment, record, quiet_noise(experiment, one.prepared)))
                        : identify_generally(experiment, record, one.file, folder, progress);
  if (!one.window.empty()) results.paragraph(one.window);
  if (one.thinned) results.paragraph(higher_modes);
  tell_preparation(results, told_of(one), experiment.format);
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

JointIdentification oscillator_of(const std::vector<IdentifyRequest>& requests, const Progress& progress) {
  std::vector<IdentifiedRecord> found;
  for (const IdentifyRequest& one : requests) {
    const std::string name = one.file.filename().string();
    progress("identifying " + name);
    try {
      const Record& record = one.prepared.record;
      found.push_back(
          {name, record, identify_record(one.experiment, record, quiet_noise(one.experiment, one.prepared))});
    } catch (const std::invalid_argument& error) {
      throw InputError({one.file.string()}, error.what());
    }
  }
  return joint_identification(std::move(found));
}

JointComparison model_of(const std::vector<IdentifyRequest>& requests, const fs::path& folder,
                         const Progress& progress) {
  std::vector<Comparison> found;
  for (const IdentifyRequest& one : requests)
    found.push_back(identify_by_comparison(one.experiment, one.prepared.record, one.file, folder, progress));
  return joint_comparison(std::move(found));
}

Results identify_together(const std::vector<IdentifyRequest>& requests, const std::string& law,
                          const fs::path& folder, const Progress& progress) {
  bool free = true;
  for (const IdentifyRequest& one : requests) free = free && one.is_free_oscillator();
  Results results = !law.empty() ? laws_of(requests, law, folder)
                    : free       ? report(requests[0].experiment, oscillator_of(requests, progress))
                                 : report(requests[0].experiment, model_of(requests, folder, progress));
  std::string thinned;
  for (const IdentifyRequest& one : requests)
    if (!one.window.empty()) results.paragraph(one.file.filename().string() + ": " + one.window);
  for (const IdentifyRequest& one : requests)
    if (one.thinned) thinned += (thinned.empty() ? "" : ", ") + one.file.filename().string();
  if (!thinned.empty()) results.paragraph(thinned + ": " + higher_modes);
  for (const IdentifyRequest& one : requests)
    tell_cost(results, one.file.filename().string(), told_of(one), one.experiment.format);
  return results;
}

/// 3 where there is no estimate to rely on, which is no error of the command's.
int exit_code(const Results& results) {
  return results.values.value("status", "converged") == "converged" ? 0 : 3;
}

int run_identify(const Values& values) {
  const Words configs = values.texts("config");
  if (configs.size() > 1) {
    deliver(values, [&] {
      try {
        return identify_family(values, {configs.begin(), configs.end()});
      } catch (const std::invalid_argument& error) {
        throw InputError({configs[0]}, error.what());
      }
    });
    return 0;
  }
  const fs::path config = configs[0];
  const std::string law = damping_law(values);
  const std::vector<IdentifyRequest> requests = identify_requests(values, config);
  if (requests.size() > 1) refuse_what_needs_one_record(requests);
  const Progress progress = show_progress(values);
  int code = 0;
  deliver(values, [&] {
    try {
      Results results = requests.size() > 1 ? identify_together(requests, law, config.parent_path(), progress)
                                            : identify_one(requests[0], law, config.parent_path(), progress);
      warn(results, requests[0].experiment);
      code = exit_code(results);
      return results;
    } catch (const std::invalid_argument& error) {
      throw InputError({config.string()}, error.what());
    }
  });
  return code;
}

}  // namespace

Command identify_command() {
  return {"identify",
          "[RECORD...] --config FILE [--window FROM TO]... [--out DIR]",
          "stiffness, damping, frequency and damping ratio from vibration records",
          {record_argument(true)},
          {identify_options(), output_options()},
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
          "3  no estimate to rely on, and \"status\" in results.json says which: the filter \"diverged\", or "
          "the modal "
          "analysis \"contradicted\" it, with less than half or more than twice the damping. The first lines "
          "say why.\n"};
}

}  // namespace beamid::apps
