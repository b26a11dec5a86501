#include "tests/fuzz/targets.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/stream/sample_line.hpp"
#include "experiments/identify/stream/streamed_identification.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/results/file.hpp"
#include "experiments/results/report_page.hpp"
#include "experiments/studies/report/joined_report.hpp"
#include "experiments/sweep/journal.hpp"
#include "experiments/sweep/manifest.hpp"
#include "experiments/sweep/read_sweep.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/json_file.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::fuzz {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

/// A folder in memory, one for each process.
class Folder {
 public:
  Folder()
      : path_((fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) /
              ("beamid-fuzz-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path write(const std::string& name, const std::string& bytes) const {
    fs::create_directories((path_ / name).parent_path());
    write_file(path_ / name, bytes);
    return path_ / name;
  }

 private:
  fs::path path_;
};

const Folder& folder() {
  static const Folder one;
  return one;
}

void promise(bool kept) {
  if (!kept) std::abort();
}

/// What the command would end with exit code 2 at.
void refusable(const auto& work) {
  try {
    work();
  } catch (const InputError&) {
  } catch (const std::invalid_argument&) {
  }
}

// ---- Records

void read_both_ways(const std::string& reader, const std::string& bytes) {
  const fs::path file = folder().write("record", bytes);
  for (const auto malformed : {MalformedRows::refuse, MalformedRows::skip, MalformedRows::as_missing})
    refusable([&] {
      RecordFormat format;
      format.reader = reader;
      format.malformed = malformed;
      format.irregular = malformed != MalformedRows::refuse;
      const Record record = read_record(file, format);
      promise(record.size() >= 2 && record.samples.rows() == static_cast<long>(record.channels.size()) &&
              record.samples.cols() == record.size() && record.time.allFinite() &&
              (malformed == MalformedRows::as_missing || record.samples.allFinite()));
      for (long k = 1; k < record.size(); ++k) promise(record.time[k] > record.time[k - 1]);
    });
}

/// Columns that say nothing of themselves: the first two are times and accelerations.
void read_unnamed(const std::string& reader, const std::string& bytes) {
  read_both_ways(reader, bytes);
  refusable([&] {
    RecordFormat format;
    format.reader = reader;
    format.sampling_rate = 100.0;
    format.channels = {{Quantity::acceleration, "", 2}};
    read_record(folder().write("record", bytes), format);
  });
}

// ---- The experiment of tutorial 2, for what is read beside one

const fs::path& tutorial() {
  static const fs::path path = fs::path(BEAMID_SOURCE_DIR) / "docs/tutorials/02_identify_a_record";
  return path;
}

std::unique_ptr<StreamedIdentification> new_stream() {
  static const Experiment experiment = read_experiment(tutorial() / "cantilever.toml");
  static const Record earlier = prepared_record(tutorial() / *experiment.record_file, experiment.format);
  return std::make_unique<StreamedIdentification>(experiment, earlier);
}

/// After 40 samples of nothing much: what read_state() and read_samples() go on from.
const nlohmann::json& saved_state() {
  static const nlohmann::json saved = [] {
    const auto stream = new_stream();
    for (int k = 0; k < 40; ++k) {
      filters::Sample sample;
      sample.time = 0.004 * k;
      sample.output = Eigen::VectorXd::Constant(1, 0.1 * (k % 3));
      stream->take_in(sample);
    }
    return nlohmann::json(stream->save());
  }();
  return saved;
}

void read_state(const std::string& bytes) {
  static const std::unique_ptr<StreamedIdentification> stream = new_stream();
  refusable([&] {
    stream->resume(read_json(folder().write("state.json", bytes), "a state"));
    for (const auto& shown : stream->shown()) promise(!(shown.deviation < 0));
    filters::Sample next;
    next.time = stream->running().time() + 0.004;
    next.output = Eigen::VectorXd::Constant(1, 0.1);
    stream->take_in(next);
    stream->save();
  });
  stream->news();
}

void read_samples(const std::string& bytes) {
  static const std::unique_ptr<StreamedIdentification> stream = new_stream();
  stream->resume(saved_state());
  refusable([&] {
    std::istringstream lines(bytes);
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
      const Place place{"standard input", ++number, 1};
      const filters::Sample sample = read_sample(line, stream->outputs(), place);
      if (!at_place(place, [&] { return stream->take_in(sample); })) return;
      stream_row(sample.time, *stream);
    }
  });
  stream->news();
}

// ---- Experiment files and sweeps

void read_experiment_file(const std::string& bytes) {
  refusable([&] { read_experiment(folder().write("experiment.toml", bytes)); });
}

void read_plan(const std::string& bytes) {
  refusable([&] {
    const auto table = TomlTable::read(folder().write("sweep.toml", bytes)).find_table("sweep");
    if (!table) return;
    const SweepPlan plan = read_sweep(*table);
    check(plan);
    for (const std::size_t number : {std::size_t{0}, plan.cases() - 1})
      promise(values_of(plan, number).size() == plan.varied.size());
  });
}

void read_journal(const std::string& bytes) {
  refusable([&] {
    SweepPlan plan;
    plan.varied = {parse_varied("damping.ratio=0.01,0.02"), parse_varied("beam.mass_kg=uniform:3:4")};
    plan.seeds = 4;
    const KeptCases kept = read_cases(folder().write("cases.csv", bytes), plan);
    promise(kept.size <= bytes.size());
    for (const SweepRow& row : kept.rows) promise(row.number < plan.cases());
  });
}

void read_sweep_manifest(const std::string& bytes) {
  refusable([&] {
    const fs::path file = folder().write("manifest.json", bytes);
    plan_of(read_manifest(file), file);
  });
}

// ---- Results that `beamid report` joins

const std::string& own_page() {
  static const std::string page =
      report_page({{"A title", "<h1>A title</h1>\n<pre>beamid modes</pre>\n<p>Text.</p>\n"}});
  return page;
}

constexpr const char* own_results = R"({"program": "beamid", "version": "0.1.0", "command": "identify",
 "configuration": {"beam": {"length_m": 1.1}}, "parameters": {"stiffness_n_per_m": {"value": 509.4,
 "standard_deviation": 0.02}}, "tables": {"runs": [{"filter": "ekf", "rms": 0.1}]}, "files": []})";

void join(const std::string& results, const std::string& page) {
  folder().write("a/results.json", results);
  folder().write("b/results.json", own_results);
  folder().write("b/report.html", own_page());
  const fs::path first = folder().write("a/report.html", page).parent_path();
  refusable([&] { write_joined_report({first, first.parent_path() / "b"}, first / "joined.html", true); });
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all{
      {"text", [](const std::string& bytes) { read_unnamed("delimited_text", bytes); }},
      {"lvm", [](const std::string& bytes) { read_unnamed("lvm", bytes); }},
      {"nied", [](const std::string& bytes) { read_unnamed("nied", bytes); }},
      {"uff58", [](const std::string& bytes) { read_both_ways("uff58", bytes); }},
      {"mat", [](const std::string& bytes) { read_unnamed("mat", bytes); }},
      {"hdf5", [](const std::string& bytes) { read_unnamed("hdf5", bytes); }},
      {"experiment", read_experiment_file},
      {"plan", read_plan},
      {"journal", read_journal},
      {"manifest", read_sweep_manifest},
      {"samples", read_samples},
      {"state", read_state},
      {"results", [](const std::string& bytes) { join(bytes, own_page()); }},
      {"page", [](const std::string& bytes) { join(own_results, bytes); }}};
  return all;
}

}  // namespace beamid::fuzz
