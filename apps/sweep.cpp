// beamid sweep: an experiment over a grid, random samples and seeds.
#include <fmt/format.h>

#include <charconv>
#include <thread>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "apps/interruption.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/results/text.hpp"
#include "experiments/studies/sweep/report.hpp"
#include "experiments/sweep/manifest.hpp"
#include "experiments/sweep/repeats.hpp"
#include "experiments/sweep/sweep_plan.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

int cores() {
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

OptionGroup sweep_options() {
  return {
      "Options",
      {config_option("experiment file; its [sweep] may hold the plan (docs/configuration.md)"),
       text("truth", "FILE",
            "experiment file of the beam that records are simulated from; without it the beam as described"),
       text("vary", "KEY=...",
            "a key of FILE, as beam.tip_mass_kg or sensors[1].noise_m: KEY=FROM:TO:STEPS[:log], KEY=A,B,C; "
            "drawn: KEY=uniform:FROM:TO, log_uniform:FROM:TO, normal:MEAN:DEVIATION; truth.KEY: of the "
            "record's beam only")
           .repeated(),
       whole("random", "N", 1, most_samples, "samples of what is drawn, at every point"),
       whole("seeds", "N", 1, most_samples, "cases for every sample, each with its own noise"),
       whole("seed", "N", 0, 2e9, "of the first case").by_default("1"),
       flag("once",
            "filter every record once from what is assumed, as the 2009 study did: model sdof, many records "
            "at a time; without it as `beamid compare` does"),
       whole("threads", "N", 1, 4096, "to work on").by_default(std::to_string(cores())).unrecorded(),
       flag("resume", "go on with a sweep that was interrupted; needs its --out DIR").unrecorded(),
       text("shard", "I/N", "this part only, from 1/N to N/N, each in a DIR of its own"),
       text("merge", "DIR...", "join the results of all shards; with --out only").several()}};
}

SweepPlan plan_in(const ExperimentText& text) {
  const auto table = TomlTable::parse(text.text, text.file.string()).find_table("sweep");
  return table ? read_sweep(*table) : SweepPlan();
}

/// That of the file, and what the command line adds to it or puts in its place.
SweepPlan plan_of(const Values& values, SweepPlan plan) {
  std::vector<VariedKey> given;
  for (const std::string& text : values.texts("vary")) {
    const VariedKey varied = at_place(Place{"--vary"}, [&] {
      VariedKey read = parse_varied(text);
      check_key(read);
      return read;
    });
    std::erase_if(plan.varied, [&](const VariedKey& one) { return one.key == varied.key; });
    given.push_back(varied);
  }
  plan.varied.insert(plan.varied.end(), given.begin(), given.end());
  if (values.has("random")) plan.samples = values.whole("random");
  if (values.has("seeds")) plan.seeds = values.whole("seeds");
  if (values.has("seed")) plan.seed = static_cast<std::uint64_t>(values.whole("seed"));
  if (values.has("once")) plan.once = true;
  at_place(Place{"sweep"}, [&] { check(plan); });
  return plan;
}

Shard shard_of(const Values& values) {
  if (!values.has("shard")) return {};
  const std::string text = values.text("shard");
  const std::size_t slash = text.find('/');
  int index = 0, count = 0;
  const char* const end = text.data() + text.size();
  const char* const middle = text.data() + std::min(slash, text.size());
  const bool read = slash != std::string::npos && std::from_chars(text.data(), middle, index).ptr == middle &&
                    std::from_chars(middle + 1, end, count).ptr == end;
  if (!read || index < 1 || count < index)
    throw UsageError("--shard is '" + text + "'; expected I/N, as 1/4 to 4/4");
  return {static_cast<std::size_t>(index - 1), static_cast<std::size_t>(count)};
}

/// Finished cases lie beside DIR until the results take their place.
fs::path journal_of(const fs::path& out) {
  fs::path plain = out;
  if (!plain.has_filename()) plain = plain.parent_path();
  return plain.string() + ".partial";
}

int merge_folders(const Values& values) {
  for (const char* other :
       {"config", "truth", "vary", "random", "seeds", "seed", "once", "threads", "resume", "shard"})
    if (values.has(other))
      throw UsageError(fmt::format("--merge takes the plan from the folders; expected no --{}", other));
  const Words words = values.texts("merge");
  return deliver(values, [&] { return merge({words.begin(), words.end()}); });
}

/// Results of the same sweep, already there: nothing is left to do but to say so again.
bool is_complete(const fs::path& out, const nlohmann::ordered_json& manifest) {
  if (!fs::exists(out / "manifest.json")) return false;
  const nlohmann::ordered_json found = read_manifest(out / "manifest.json");
  if (found["hash"] != manifest["hash"] || found["shard"] != manifest["shard"])
    throw UsageError("'" + out.string() + "' holds the results of another sweep; expected another --out");
  return true;
}

thread_local Processes* all_processes = nullptr;  // while the command runs

/// Processes that mpirun started beside the first do nothing but help it.
int with_processes(const std::function<int()>& work) {
  Processes processes;
  if (!processes.first()) {
    help(processes);
    return 0;
  }
  all_processes = &processes;
  return work();
}

/// The command as far as the plan is no part of it.
std::string without_plan(const Values& values) {
  std::string command = "beamid sweep";
  if (values.has("record")) command += " " + shell_word(values.texts("record")[0]);
  for (const char* option : {"config", "truth"})
    if (values.has(option)) command += fmt::format(" --{} {}", option, shell_word(values.text(option)));
  return command;
}

int run_sweep(const Values& given) {
  Values values = given;
  if (values.has("merge")) return merge_folders(values);
  if (!values.has("config")) throw UsageError("which --config FILE?");
  if (values.has("resume") && !values.has("out"))
    throw UsageError("--resume needs the --out DIR of the sweep that was interrupted");
  SweepSource source{read_experiment_text(values.text("config")), {}, {}};
  if (values.has("truth")) source.truth = read_experiment_text(values.text("truth"));
  if (values.has("record") && values.has("truth"))
    throw UsageError("RECORD and --truth exclude each other; expected one of them");
  const Experiment experiment = read_experiment(source.config.file);
  if (values.has("record"))
    source.record = values.texts("record")[0];
  else if (!source.truth && experiment.record_file)
    source.record = source.config.file.parent_path() / *experiment.record_file;
  const SweepPlan plan = plan_of(values, plan_in(source.config));
  if (plan.once) at_place(Place{"sweep"}, [&] { require_once(source, plan); });
  SweepSettings settings{shard_of(values), 1, {}, {}, values.has("resume"), all_processes};
  if (all_processes->count() > 1 && values.has("threads"))
    throw UsageError(
        "--threads has no use under mpirun, where each process runs one case at a time; expected a "
        "process more than there are cores");
  settings.threads = values.whole("threads");
  const nlohmann::ordered_json manifest = manifest_of(source, plan, settings.shard);
  if (values.has("out")) {
    const fs::path out = values.text("out");
    settings.journal = journal_of(out);
    if (settings.resume && !fs::exists(*settings.journal / "manifest.json") && is_complete(out, manifest)) {
      settings.done = out / "cases.csv";
      values.set("force");
    }
    if (values.has("force") && !settings.resume && !discard_journal(*settings.journal))
      throw UsageError("another beamid sweep is running on '" + out.string() + "'; expected another --out");
  }
  const std::string kept = settings.journal
                               ? fmt::format("are kept in '{}': the same command with --resume goes on",
                                             settings.journal->string())
                               : "were finished; with --out DIR they are kept, and --resume goes on";
  Interruption interruption("interrupted; no case was finished");
  const int code = deliver(values, [&] {
    const Progress progress = [&, shown = show_progress(values)](const std::string& what) {
      interruption.say(fmt::format("interrupted; {} cases {}", what.substr(0, what.find(" cases")), kept));
      shown(what);
    };
    Results results = report(manifest, plan, perform(source, plan, settings, progress), without_plan(values));
    warn(results, experiment);
    return results;
  });
  if (settings.journal) discard_journal(*settings.journal);
  return code;
}

}  // namespace

Command sweep_command() {
  return {
      "sweep",
      "[RECORD | --truth FILE] --config FILE [--vary KEY=...]... [--seeds N] [--out DIR]",
      "an experiment over a grid, random samples and seeds: bias, rms, bound, coverage, divergence",
      {{.name = "record"}},
      {sweep_options(), output_options()},
      "  beamid sweep --config rig.toml --vary damping.ratio=0.001:0.1:5:log --seeds 200 --out swept\n"
      "  beamid sweep --config rig.toml --vary filter.method=ekf,ukf --vary sensors[1].noise_m=1e-5,1e-4\n"
      "  beamid sweep --config rig.toml --vary truth.beam.tip_mass_kg=uniform:0.3:0.4 --random 500\n"
      "  beamid sweep --config rig.toml --seeds 1000 --out swept --resume\n"
      "  beamid sweep --config rig.toml --seeds 1000 --shard 3/8 --out part3\n"
      "  beamid sweep --merge part1 part2 part3 --out all\n"
      "  mpirun -n 9 beamid sweep --config rig.toml --seeds 1000 --out swept    # 8 cores\n",
      run_sweep,
      "",
      "",
      with_processes};
}

}  // namespace beamid::apps
