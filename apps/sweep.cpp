// beamid sweep: an experiment over a grid, random samples and seeds.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <thread>

#include "apps/deliver.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_sweep.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/studies/sweep/perform.hpp"
#include "experiments/studies/sweep/report.hpp"
#include "experiments/sweep/journal.hpp"
#include "experiments/sweep/repeats.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;
using Words = std::vector<std::string>;

options::options_description sweep_options() {
  options::options_description described("Options");
  described.add_options()  //
      ("config", options::value<std::string>()->value_name("FILE"),
       "experiment file; its [sweep] may hold the plan (docs/configuration.md)")  //
      ("truth", options::value<std::string>()->value_name("FILE"),
       "experiment file of the beam that records are simulated from; without it the beam as described")  //
      ("vary", options::value<Words>()->value_name("KEY=..."),
       "a key of FILE, as beam.tip_mass_kg or sensors[1].noise_m: KEY=FROM:TO:STEPS[:log], KEY=A,B,C; drawn: "
       "KEY=uniform:FROM:TO, log_uniform:FROM:TO, normal:MEAN:DEVIATION; truth.KEY: of the record's beam "
       "only. Repeat for more")                                                                          //
      ("random", options::value<double>()->value_name("N"), "samples of what is drawn, at every point")  //
      ("seeds", options::value<double>()->value_name("N"), "cases for every sample, each with its own noise")(
          "seed", options::value<double>()->value_name("N"), "of the first case [1]")  //
      ("once",
       "filter every record once from what is believed, as the 2009 study did: model sdof, many records "
       "at a time; without it as `beamid compare` does")                                //
      ("threads", options::value<double>()->value_name("N"), "to work on [all cores]")  //
      ("resume", "go on with a sweep that was interrupted; needs its --out DIR")        //
      ("shard", options::value<std::string>()->value_name("I/N"),
       "this part only, from 1/N to N/N, each in a DIR of its own")  //
      ("merge", options::value<Words>()->multitoken()->value_name("DIR..."),
       "join the results of all shards; with --out only");
  return described;
}

int whole(const options::variables_map& values, const char* name, double least, double most) {
  const double value = values[name].as<double>();
  if (!(value >= least && value <= most && value == std::floor(value)))
    throw UsageError(fmt::format("sweep: --{} is {:g}; expected a whole number from {:g} to {:g}", name,
                                 value, least, most));
  return static_cast<int>(value);
}

/// That of the file, and what the command line adds to it or puts in its place.
SweepPlan plan_of(const options::variables_map& values, SweepPlan plan) {
  std::vector<VariedKey> given;
  for (const std::string& text : values.count("vary") ? values["vary"].as<Words>() : Words()) {
    const VariedKey varied = at_place(Place{"--vary"}, [&] {
      VariedKey read = parse_varied(text);
      refuse_unknown(read);
      return read;
    });
    std::erase_if(plan.varied, [&](const VariedKey& one) { return one.key == varied.key; });
    given.push_back(varied);
  }
  plan.varied.insert(plan.varied.end(), given.begin(), given.end());
  if (values.count("random")) plan.samples = whole(values, "random", 1, most_samples);
  if (values.count("seeds")) plan.seeds = whole(values, "seeds", 1, most_samples);
  if (values.count("seed")) plan.seed = static_cast<std::uint64_t>(whole(values, "seed", 0, 2e9));
  if (values.count("once")) plan.once = true;
  at_place(Place{"sweep"}, [&] { check(plan); });
  return plan;
}

Shard shard_of(const options::variables_map& values) {
  if (!values.count("shard")) return {};
  const std::string text = values["shard"].as<std::string>();
  const std::size_t slash = text.find('/');
  int index = 0, count = 0;
  const char* const end = text.data() + text.size();
  const char* const middle = text.data() + std::min(slash, text.size());
  const bool read = slash != std::string::npos && std::from_chars(text.data(), middle, index).ptr == middle &&
                    std::from_chars(middle + 1, end, count).ptr == end;
  if (!read || index < 1 || count < index)
    throw UsageError("sweep: --shard is '" + text + "'; expected I/N, as 1/4 to 4/4");
  return {static_cast<std::size_t>(index - 1), static_cast<std::size_t>(count)};
}

/// Finished cases lie beside DIR until the results take their place.
fs::path journal_of(const fs::path& out) {
  fs::path plain = out;
  if (!plain.has_filename()) plain = plain.parent_path();
  return plain.string() + ".partial";
}

int merge_folders(const options::variables_map& values) {
  for (const char* other :
       {"config", "truth", "vary", "random", "seeds", "seed", "once", "threads", "resume", "shard"})
    if (values.count(other))
      throw UsageError(
          fmt::format("sweep: --merge takes the plan from the folders; expected no --{}", other));
  const Words words = values["merge"].as<Words>();
  deliver(values, [&] { return merge({words.begin(), words.end()}); });
  return 0;
}

/// Results of the same sweep, already there: nothing is left to do but to say so again.
bool is_complete(const fs::path& out, const nlohmann::ordered_json& manifest) {
  if (!fs::exists(out / "manifest.json")) return false;
  const nlohmann::ordered_json found = read_manifest(out / "manifest.json");
  if (found["hash"] != manifest["hash"] || found["shard"] != manifest["shard"])
    throw UsageError("sweep: '" + out.string() +
                     "' holds the results of another sweep; expected another --out");
  return true;
}

int run(const Command& command, const Words& arguments) {
  Processes processes;
  if (!processes.first()) {
    help(processes);
    return 0;
  }
  options::options_description described = sweep_options();
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {"record"}, values)) return 0;
  if (values.count("merge")) return merge_folders(values);
  if (!values.count("config")) throw UsageError("sweep: which --config FILE?");
  if (values.count("resume") && !values.count("out"))
    throw UsageError("sweep: --resume needs the --out DIR of the sweep that was interrupted");
  SweepSource source{read_experiment_text(values["config"].as<std::string>()), {}, {}};
  if (values.count("truth")) source.truth = read_experiment_text(values["truth"].as<std::string>());
  if (values.count("record") && values.count("truth"))
    throw UsageError("sweep: RECORD and --truth exclude each other; expected one of them");
  const Experiment experiment = read_experiment(source.config.file);
  if (values.count("record"))
    source.record = values["record"].as<std::string>();
  else if (!source.truth && experiment.record_file)
    source.record = source.config.file.parent_path() / *experiment.record_file;
  const SweepPlan plan = plan_of(values, experiment.sweep);
  if (plan.once) at_place(Place{"sweep"}, [&] { require_once(source, plan); });
  SweepSettings settings{shard_of(values), 1, {}, {}, values.count("resume") > 0, &processes};
  if (processes.count() > 1 && values.count("threads"))
    throw UsageError(
        "sweep: --threads has no use under mpirun, where each process runs one case at a time; expected a "
        "process more than there are cores");
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  settings.threads = values.count("threads") ? whole(values, "threads", 1, 4096) : cores;
  const nlohmann::ordered_json manifest = manifest_of(source, plan, settings.shard);
  if (values.count("out")) {
    const fs::path out = values["out"].as<std::string>();
    settings.journal = journal_of(out);
    if (settings.resume && !fs::exists(*settings.journal / "manifest.json") && is_complete(out, manifest)) {
      settings.done = out / "cases.csv";
      values.insert({"force", options::variable_value(true, false)});
    }
    if (values.count("force") && !settings.resume && !discard_journal(*settings.journal))
      throw UsageError("sweep: another beamid sweep is running on '" + out.string() +
                       "'; expected another --out");
  }
  deliver(values, [&] {
    Results results = report(manifest, plan, perform(source, plan, settings, show_progress()));
    warn(results, experiment);
    return results;
  });
  if (settings.journal) discard_journal(*settings.journal);
  return 0;
}

}  // namespace

Command sweep_command() {
  return {
      "sweep", "[RECORD | --truth FILE] --config FILE [--vary KEY=...]... [--seeds N] [--out DIR]",
      "an experiment over a grid, random samples and seeds: bias, rms, bound, coverage, divergence",
      "  beamid sweep --config rig.toml --vary damping.ratio=0.001:0.1:5:log --seeds 200 --out swept\n"
      "  beamid sweep --config rig.toml --vary filter.method=ekf,ukf --vary sensors[1].noise_m=1e-5,1e-4\n"
      "  beamid sweep --config rig.toml --vary truth.beam.tip_mass_kg=uniform:0.3:0.4 --random 500\n"
      "  beamid sweep --config rig.toml --seeds 1000 --out swept --resume\n"
      "  beamid sweep --config rig.toml --seeds 1000 --shard 3/8 --out part3\n"
      "  beamid sweep --merge part1 part2 part3 --out all\n"
      "  mpirun -n 9 beamid sweep --config rig.toml --seeds 1000 --out swept    # 8 cores\n",
      run};
}

}  // namespace beamid::apps
