
#include "experiments/studies/sweep/report.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/sweep/manifest.hpp"
#include "experiments/sweep/repeats.hpp"
#include "experiments/sweep/rows.hpp"
#include "experiments/text/memory_need.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {
namespace {

// What another process has to know to run cases of a sweep.

struct SweepJob {
  SweepSource source;
  SweepPlan plan;
};

/// The manifest, and where the files are.
std::string job_text(const SweepSource& source, const nlohmann::ordered_json& manifest);

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string job_text(const SweepSource& source, const Json& manifest) {
  const auto place = [](const fs::path& file) { return fs::absolute(file).string(); };
  Json job{{"manifest", manifest}, {"config", place(source.config.file)}};
  if (source.truth) job["truth"] = place(source.truth->file);
  if (source.record) job["record"] = place(*source.record);
  return job.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// @throws std::runtime_error when the same job has another hash here: this process is of another version, or
/// finds other contents in the files that the experiment names.
SweepJob read_job(const std::string& text) {
  const Json given = Json::parse(text), &manifest = given.at("manifest");
  SweepJob job;
  job.source.config = {given.at("config").get<std::string>(), manifest.at("experiment").get<std::string>()};
  if (given.contains("truth"))
    job.source.truth = {given.at("truth").get<std::string>(), manifest.at("truth").get<std::string>()};
  if (given.contains("record")) job.source.record = given.at("record").get<std::string>();
  job.plan = plan_of(manifest, "manifest.json");
  const std::string here = manifest_of(job.source, job.plan, {})["hash"], there = manifest.at("hash");
  if (here != there)
    throw std::runtime_error(
        fmt::format("the sweep has the hash {} here; expected {}, with the same version of beamid and the "
                    "same contents of the files that the experiment names",
                    here, there));
  return job;
}

/// What is wrong with the files themselves is better said once than in every case.
void read_once(const SweepSource& source) {
  read_experiment(TomlTable::parse(source.config.text, source.config.file.string()));
  if (source.truth) read_experiment(TomlTable::parse(source.truth->text, source.truth->file.string()));
}

std::vector<std::size_t> left(const SweepPlan& plan, const Shard& shard, const std::vector<SweepRow>& kept) {
  std::vector<bool> done(plan.cases(), false);
  for (const SweepRow& row : kept) done[row.number] = true;
  std::vector<std::size_t> numbers;
  for (std::size_t number = 0; number < done.size(); ++number)
    if (shard.holds(number) && !done[number]) numbers.push_back(number);
  return numbers;
}

CaseRunner runner(const SweepSource& source, const SweepPlan& plan) {
  if (!plan.once)
    return [&](const CaseBlock& block) {
      std::vector<SweepRow> rows;
      for (const std::size_t number : block)
        for (SweepRow& row : run_case(source, plan, number)) rows.push_back(std::move(row));
      return rows;
    };
  const auto repeats = std::make_shared<Repeats>(source, plan);
  return [repeats](const CaseBlock& block) { return repeats->run(block); };
}

/// Their number, not that of their rows.
std::size_t cases_in(const std::vector<SweepRow>& rows) {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [](const SweepRow& row) { return row.row == 1; }));
}

}  // namespace

std::vector<SweepRow> perform(const SweepSource& source, const SweepPlan& plan, const SweepSettings& settings,
                              const Progress& progress) {
  read_once(source);
  constexpr double case_bytes =
      sizeof(SweepRow) + 64;  // one row, without its texts, and its place in the queue
  require_memory(static_cast<double>(plan.cases()) / static_cast<double>(settings.shard.count),
                 "cases of a sweep", case_bytes);
  std::optional<Journal> journal;
  std::vector<SweepRow> rows;
  if (settings.done) rows = read_cases(*settings.done, plan).rows;
  if (settings.journal && !settings.done) {
    journal.emplace(*settings.journal, manifest_of(source, plan, settings.shard), plan, settings.resume);
    rows = journal->kept();
  }
  CaseQueue queue(blocks_of(plan, left(plan, settings.shard, rows)));
  const std::size_t before = cases_in(rows);
  Countdown shown(progress, before + queue.cases(), "cases", before);
  const CaseSink keep = [&](std::vector<SweepRow> found) {
    if (journal) journal->append(found);
    shown.count(cases_in(found));
    rows.insert(rows.end(), std::make_move_iterator(found.begin()), std::make_move_iterator(found.end()));
  };
  if (settings.processes && settings.processes->count() > 1)
    settings.processes->run(queue, plan, job_text(source, manifest_of(source, plan, {})), keep);
  else
    run_cases(queue, settings.threads, runner(source, plan), keep);
  sort_rows(rows);
  const bool none = !rows.empty() && std::all_of(rows.begin(), rows.end(),
                                                 [](const SweepRow& row) { return row.status == "failed"; });
  if (none && settings.shard.count == 1)
    throw std::runtime_error(fmt::format("no case could be run; the first: {}", rows[0].reason));
  return rows;
}

void help(Processes& processes) {
  processes.work([](const std::string& text) -> CaseRunner {
    const auto job = std::make_shared<const SweepJob>(read_job(text));
    return [job, run = runner(job->source, job->plan)](const CaseBlock& block) { return run(block); };
  });
}

Results merge(const std::vector<fs::path>& folders) {
  nlohmann::ordered_json manifest;
  SweepPlan plan;
  std::vector<SweepRow> rows;
  std::set<std::size_t> numbers;
  for (const fs::path& folder : folders) {
    const fs::path described = folder / "manifest.json", file = folder / "cases.csv";
    const nlohmann::ordered_json found = read_manifest(described);
    if (manifest.is_null()) {
      manifest = found;
      plan = plan_of(found, described);
    }
    if (found["hash"] != manifest["hash"])
      throw InputError({described.string()},
                       fmt::format("plan {}; expected {}, that of '{}'", found["hash"].get<std::string>(),
                                   manifest["hash"].get<std::string>(), folders[0].string()));
    const std::vector<SweepRow> here = read_cases(file, plan).rows;
    for (const SweepRow& row : here)
      if (row.row == 1 && !numbers.insert(row.number).second)
        throw InputError(
            {file.string()},
            fmt::format("case {} is in another folder too; expected each shard once", row.number));
    rows.insert(rows.end(), here.begin(), here.end());
  }
  if (numbers.size() < plan.cases()) {
    std::size_t missing = 0;
    while (numbers.contains(missing)) ++missing;
    throw InputError(
        {folders[0].string()},
        fmt::format("{} of {} cases are missing, the first is {}; expected the folders of all shards",
                    plan.cases() - numbers.size(), plan.cases(), missing));
  }
  sort_rows(rows);
  manifest["shard"] = {{"index", 1}, {"count", 1}};
  return report(manifest, plan, std::move(rows));
}

}  // namespace beamid::experiments
