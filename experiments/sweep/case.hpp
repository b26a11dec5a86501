// One case of a sweep: the experiment with its keys set, simulated and identified.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/compare/comparison.hpp"
#include "experiments/sweep/rows.hpp"

namespace beamid::experiments {

/// An experiment file held in memory: cases read it again and again, the same whatever happens to the file.
struct ExperimentText {
  std::filesystem::path file;
  std::string text;
};

ExperimentText read_experiment_text(const std::filesystem::path& file);

struct SweepSource {
  ExperimentText config;
  std::optional<ExperimentText> truth;          ///< what records are simulated from; absent: the same beam
  std::optional<std::filesystem::path> record;  ///< measured: nothing is simulated, truth is not known
};

/// The experiment of a case, its lists of reductions, filters and discretisations completed by its single
/// choices. @param of_truth that of the record simulated. @throws InputError
Experiment experiment_of(const SweepSource& source, const SweepPlan& plan, std::size_t number,
                         bool of_truth = false);

/// The case's rows, `row` and `rows` set. Throws nothing but std::bad_alloc: trouble is a row.
std::vector<SweepRow> run_case(const SweepSource& source, const SweepPlan& plan, std::size_t number);

/// The same of runs that have been made. @param trouble where none could be made
std::vector<SweepRow> rows_of(const SweepPlan& plan, std::size_t number, const std::vector<ComparedRun>& runs,
                              const std::string& trouble = "");

}  // namespace beamid::experiments
