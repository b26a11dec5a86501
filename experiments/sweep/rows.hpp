// What a sweep keeps of a case, as lines of CSV.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/sweep/sweep_plan.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// One unknown of one run of a case; a run that found nothing has one row without an unknown, NaN for
/// numbers.
struct SweepRow {
  std::size_t number = 0;           ///< of the case
  std::size_t row = 1, rows = 1;    ///< this one, from 1, and how many the case has
  std::uint64_t seed = 0;           ///< simulation.seed
  std::vector<std::string> values;  ///< of the keys that vary, in the plan's order
  std::string reduction, filter, discretisation;
  std::string status;  ///< converged, diverged, refused; failed: the case could not be run at all
  std::string parameter, unit;
  double estimate = std::nan(""), truth = std::nan(""), error = std::nan("");   ///< [unit]
  double deviation = std::nan(""), lower = std::nan(""), upper = std::nan("");  ///< 95 % [unit]
  double bound = std::nan("");                                                  ///< Cramer-Rao [unit]
  std::string reason;                                                           ///< on one line
};

/// The numbers of a row in the order of their columns, and the names of these.
const std::vector<std::pair<const char*, double SweepRow::*>>& number_columns();
/// Likewise the texts.
const std::vector<std::pair<const char*, std::string SweepRow::*>>& text_columns();

/// "case,row,rows,seed,KEY...,reduction,...,reason\n"
std::string header_line(const SweepPlan& plan);
/// With its end "\n", the only one in it. Numbers read back the same.
std::string to_line(const SweepRow& row);
/// @param line without its end. Nothing where it is no such row with so many values.
std::optional<SweepRow> from_line(std::string_view line, std::size_t values);

// One case of a sweep: the experiment with its keys set, simulated and identified.

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

// The cases of a sweep on all cores.

/// Cases that are run together, usually one.
using CaseBlock = std::vector<std::size_t>;

/// The blocks of the cases that are left: one by one, or, where the plan identifies once, up to 16 neighbours
/// that differ in their seeds alone. No result depends on it.
std::vector<CaseBlock> blocks_of(const SweepPlan& plan, const std::vector<std::size_t>& numbers);

/// Hands out the blocks that are left, one by one, to any thread.
class CaseQueue {
 public:
  explicit CaseQueue(std::vector<CaseBlock> blocks) : blocks_(std::move(blocks)) {}
  /// False when there is none any more. @param block the next one
  bool next(CaseBlock& block);
  void stop();  ///< hands out no more
  std::size_t blocks() const;
  std::size_t cases() const;  ///< of all blocks

 private:
  std::mutex mutex_;
  std::vector<CaseBlock> blocks_;
  std::size_t given_ = 0;
};

using CaseRunner = std::function<std::vector<SweepRow>(const CaseBlock& block)>;
using CaseSink = std::function<void(std::vector<SweepRow> rows)>;

/// Runs what the queue hands out on so many threads, or on fewer where there are not as many blocks or the
/// system does not allow them. The sink gets every block when it is finished, in
/// whatever order, from one thread at a time. The first exception of runner or sink stops the rest and is
/// thrown when all threads have ended.
void run_cases(CaseQueue& queue, int threads, const CaseRunner& run, const CaseSink& sink);

/// Rows in the order of their cases.
void sort_rows(std::vector<SweepRow>& rows);

// A sweep on several processes, on one machine or many, started by `mpirun -n N beamid sweep ...`.
//
// The first process hands out the cases one by one and keeps what comes back; the others ask for a case, run
// it, send its rows and thereby ask for the next. Whoever is faster gets more. The first needs hardly any
// processor time: N processes compute on N - 1 cores.

/// The processes that mpirun has started together with this one. There is one only where it was not mpirun
/// that started it, or beamid was built without MPI, which is then not touched.
class Processes {
 public:
  /// @throws std::runtime_error when mpirun has started several and beamid was built without MPI: each would
  /// run the whole sweep.
  Processes();
  ~Processes();  ///< of the first process: sends home those that are still waiting
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  int count() const { return count_; }
  bool first() const { return rank_ == 0; }

  /// In the first process, as run_cases(): the cases of the queue, run by the others. The sink's exception,
  /// or trouble of another process, stops the rest and is thrown when all have ended.
  /// @param job what the others have to know, any bytes
  void run(CaseQueue& queue, const SweepPlan& plan, const std::string& job, const CaseSink& sink);

  /// In the others: waits for a job and runs what is handed out, until there is nothing left.
  /// @param prepare makes of the job what runs its cases; an exception of either is told to the first.
  void work(const std::function<CaseRunner(const std::string& job)>& prepare);

 private:
  int count_ = 1, rank_ = 0;
  int waiting_ = 0;  ///< others that have not been sent home
  bool started_ = false;
};

}  // namespace beamid::experiments
