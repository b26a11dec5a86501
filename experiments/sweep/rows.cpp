#include "experiments/sweep/rows.hpp"

#include <algorithm>
#include <charconv>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <tuple>

#include "experiments/config/read_experiment.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/sweep/sweep_plan.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

template <class Number>
bool read(std::string_view field, Number& number) {
  const char* const end = field.data() + field.size();
  const auto [rest, error] = std::from_chars(field.data(), end, number);
  return error == std::errc() && rest == end;
}

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

const std::vector<std::pair<const char*, double SweepRow::*>>& number_columns() {
  static const std::vector<std::pair<const char*, double SweepRow::*>> columns{
      {"estimate", &SweepRow::estimate},   {"truth", &SweepRow::truth},    {"error", &SweepRow::error},
      {"deviation", &SweepRow::deviation}, {"lower_95", &SweepRow::lower}, {"upper_95", &SweepRow::upper},
      {"bound", &SweepRow::bound}};
  return columns;
}

const std::vector<std::pair<const char*, std::string SweepRow::*>>& text_columns() {
  static const std::vector<std::pair<const char*, std::string SweepRow::*>> columns{
      {"reduction", &SweepRow::reduction},
      {"filter", &SweepRow::filter},
      {"discretisation", &SweepRow::discretisation},
      {"status", &SweepRow::status},
      {"parameter", &SweepRow::parameter},
      {"unit", &SweepRow::unit},
      {"reason", &SweepRow::reason}};
  return columns;
}

std::string header_line(const SweepPlan& plan) {
  std::string line = "case,row,rows,seed";
  for (const VariedKey& one : plan.varied) line += "," + csv_field(one.key);
  for (const auto& [name, member] : text_columns()) line.append(",").append(name);
  for (const auto& [name, member] : number_columns()) line.append(",").append(name);
  return line + "\n";
}

std::string to_line(const SweepRow& row) {
  std::string line = std::to_string(row.number) + "," + std::to_string(row.row) + "," +
                     std::to_string(row.rows) + "," + std::to_string(row.seed);
  for (const std::string& value : row.values) line += "," + csv_field(on_one_line(value));
  for (const auto& [name, member] : text_columns()) line += "," + csv_field(on_one_line(row.*member));
  for (const auto& [name, member] : number_columns()) line += "," + csv_field(row.*member);
  return line + "\n";
}

std::optional<SweepRow> from_line(std::string_view line, std::size_t values) {
  std::vector<std::string_view> fields;
  split_fields(line, ',', fields, true);
  constexpr std::size_t counts = 4;
  const std::size_t texts = text_columns().size(), numbers = number_columns().size();
  const bool torn = std::any_of(fields.begin(), fields.end(), [](std::string_view field) {
    return field.starts_with('"') && (field.size() < 2 || !field.ends_with('"'));
  });
  if (torn || fields.size() != counts + values + texts + numbers) return {};
  SweepRow row;
  if (!read(fields[0], row.number) || !read(fields[1], row.row) || !read(fields[2], row.rows) ||
      !read(fields[3], row.seed))
    return {};
  auto field = fields.begin() + counts;
  for (std::size_t j = 0; j < values; ++j) row.values.push_back(field_text(*field++));
  for (const auto& [name, member] : text_columns()) row.*member = field_text(*field++);
  for (const auto& [name, member] : number_columns()) {
    if (!field->empty() && !read(*field, row.*member)) return {};
    ++field;
  }
  return row;
}

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

namespace {

/// Threads beside this one. Where the system refuses one, half of those that it allowed go at once, and all
/// that have no core of their own: the work needs the memory that they would take. None works before that is
/// decided.
class Helpers {
 public:
  Helpers(std::size_t wanted, const std::function<void()>& work) {
    threads_.reserve(wanted);
    std::size_t needed = wanted;
    try {
      while (threads_.size() < wanted)
        threads_.emplace_back([this, work, number = threads_.size()] {
          if (is_needed(number)) work();
        });
    } catch (const std::exception&) {  // no thread, or no memory for one
      const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
      needed = std::min(threads_.size() / 2, cores - 1);
    }
    decide(needed);
    for (; threads_.size() > needed; threads_.pop_back()) threads_.back().join();
    decide(needed, true);
  }
  ~Helpers() { join(); }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  void join() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  void decide(std::size_t needed, bool go = false) {
    const std::lock_guard lock(mutex_);
    needed_ = needed;
    go_ = go;
    decided_.notify_all();
  }

  bool is_needed(std::size_t number) {
    std::unique_lock lock(mutex_);
    decided_.wait(lock, [&] { return go_ || (needed_ && number >= *needed_); });
    return number < *needed_;
  }

  std::mutex mutex_;
  std::condition_variable decided_;
  std::optional<std::size_t> needed_;
  bool go_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

std::vector<CaseBlock> blocks_of(const SweepPlan& plan, const std::vector<std::size_t>& numbers) {
  const std::size_t most = plan.once ? 16 : 1;
  std::vector<CaseBlock> blocks;
  for (const std::size_t number : numbers) {
    const bool joins = !blocks.empty() && blocks.back().size() < most &&
                       plan.sample_of(blocks.back().front()) == plan.sample_of(number);
    if (!joins) blocks.emplace_back();
    blocks.back().push_back(number);
  }
  return blocks;
}

bool CaseQueue::next(CaseBlock& block) {
  const std::lock_guard lock(mutex_);
  if (given_ >= blocks_.size()) return false;
  block = blocks_[given_++];
  return true;
}

void CaseQueue::stop() {
  const std::lock_guard lock(mutex_);
  given_ = blocks_.size();
}

std::size_t CaseQueue::blocks() const {
  return blocks_.size();
}

std::size_t CaseQueue::cases() const {
  std::size_t count = 0;
  for (const CaseBlock& block : blocks_) count += block.size();
  return count;
}

void run_cases(CaseQueue& queue, int threads, const CaseRunner& run, const CaseSink& sink) {
  std::mutex one_at_a_time;
  std::exception_ptr trouble;
  const auto work = [&] {
    try {
      for (CaseBlock block; queue.next(block);) {
        std::vector<SweepRow> rows = run(block);
        const std::lock_guard lock(one_at_a_time);
        if (trouble) return;
        sink(std::move(rows));
      }
    } catch (...) {
      queue.stop();
      const std::lock_guard lock(one_at_a_time);
      if (!trouble) trouble = std::current_exception();
    }
  };
  const std::size_t most = std::max<std::size_t>(queue.blocks(), 1);
  Helpers helpers(std::min(static_cast<std::size_t>(threads), most) - 1, work);
  work();
  helpers.join();
  if (trouble) std::rethrow_exception(trouble);
}

void sort_rows(std::vector<SweepRow>& rows) {
  std::sort(rows.begin(), rows.end(), [](const SweepRow& a, const SweepRow& b) {
    return std::tie(a.number, a.row) < std::tie(b.number, b.row);
  });
}

}  // namespace beamid::experiments
