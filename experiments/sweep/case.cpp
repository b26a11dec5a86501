#include "experiments/sweep/case.hpp"

#include <algorithm>
#include <mutex>
#include <new>

#include "experiments/config/read_experiment.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/sweep/read_sweep.hpp"
#include "experiments/text/text_file.hpp"
#include "experiments/text/words.hpp"

namespace beamid::experiments {
namespace {

std::vector<Override> overrides_of(const SweepPlan& plan, std::size_t number, bool of_truth) {
  const std::string mark = "truth.";
  const std::vector<filters::OptionValue> values = values_of(plan, number);
  std::vector<Override> overrides;
  for (std::size_t j = 0; j < values.size(); ++j) {
    std::string key = plan.varied[j].key;
    if (key.starts_with(mark) && !of_truth) continue;
    if (key.starts_with(mark)) key.erase(0, mark.size());
    const std::size_t dot = key.rfind('.');
    overrides.push_back({key.substr(0, dot), key.substr(dot + 1), values[j], "the sweep", keys_instead(key)});
  }
  if (of_truth)
    overrides.push_back({"simulation", "seed", static_cast<double>(plan.seed_of(number)), "sweep.seed"});
  return overrides;
}

Record record_of(const std::filesystem::path& file, const RecordFormat& format) {
  static std::mutex one_at_a_time;  // HDF5 takes no two threads
  const std::lock_guard lock(one_at_a_time);
  return prepared_record(file, format);
}

ComparedRecord compared_record(const SweepSource& source, const SweepPlan& plan, std::size_t number,
                               const Experiment& experiment) {
  if (!source.record) {
    const std::filesystem::path& file = (source.truth ? *source.truth : source.config).file;
    return simulated_record(experiment_of(source, plan, number, true), file.parent_path(),
                            [](const std::string&) {});
  }
  ComparedRecord compared;
  compared.record = record_of(*source.record, experiment.format);
  return compared;
}

SweepRow row_of(const SweepRow& common, const ComparedRun& run) {
  SweepRow row = common;
  row.reduction = run.reduction;
  row.filter = run.filter;
  row.discretisation = run.discretisation;
  row.status = to_string(run.status);
  row.reason = run.reason;
  return row;
}

void add_rows(const ComparedRun& run, const SweepRow& common, std::vector<SweepRow>& rows) {
  if (run.parameters.empty()) rows.push_back(row_of(common, run));
  for (const ComparedParameter& one : run.parameters) {
    SweepRow row = row_of(common, run);
    row.parameter = one.estimate.name;
    row.unit = one.estimate.unit;
    row.estimate = one.estimate.value;
    row.deviation = one.estimate.deviation;
    row.lower = one.estimate.lower_95;
    row.upper = one.estimate.upper_95;
    if (one.truth) row.truth = *one.truth;
    row.error = row.estimate - row.truth;
    if (one.bound) row.bound = *one.bound;
    rows.push_back(row);
  }
}

}  // namespace

ExperimentText read_experiment_text(const std::filesystem::path& file) {
  return {file, read_text(file, "a TOML file")};
}

Experiment experiment_of(const SweepSource& source, const SweepPlan& plan, std::size_t number,
                         bool of_truth) {
  const ExperimentText& text = of_truth && source.truth ? *source.truth : source.config;
  std::vector<Override> overrides = overrides_of(plan, number, of_truth);
  if (of_truth && source.truth)  // what is assumed is not its business
    std::erase_if(overrides, [&](const Override& over) {
      return over.table != "simulation" &&
             std::none_of(plan.varied.begin(), plan.varied.end(),
                          [&](auto& one) { return one.key == "truth." + over.table + "." + over.key; });
    });
  Experiment experiment = read_experiment(TomlTable::parse(text.text, text.file.string(), overrides));
  if (experiment.reductions.empty()) experiment.reductions = {experiment.reduction};
  if (experiment.filters.empty()) experiment.filters = {experiment.filter};
  if (experiment.discretisations.empty()) experiment.discretisations = {experiment.discretisation};
  return experiment;
}

std::vector<SweepRow> rows_of(const SweepPlan& plan, std::size_t number, const std::vector<ComparedRun>& runs,
                              const std::string& trouble) {
  SweepRow common;
  common.number = number;
  common.seed = plan.seed_of(number);
  for (const filters::OptionValue& value : values_of(plan, number)) common.values.push_back(word_of(value));
  std::vector<SweepRow> rows;
  for (const ComparedRun& run : runs) add_rows(run, common, rows);
  if (runs.empty()) {
    rows = {common};
    rows[0].status = "failed";
    rows[0].reason = trouble;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].row = i + 1;
    rows[i].rows = rows.size();
  }
  return rows;
}

std::vector<SweepRow> run_case(const SweepSource& source, const SweepPlan& plan, std::size_t number) {
  try {
    const Experiment experiment = experiment_of(source, plan, number);
    const Comparison found = compare(experiment, compared_record(source, plan, number, experiment),
                                     source.config.file.parent_path(), [](const std::string&) {});
    return rows_of(plan, number, found.runs);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return rows_of(plan, number, {}, error.what());
  }
}

}  // namespace beamid::experiments
