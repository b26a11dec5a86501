#include "tests/fuzz/targets.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/stream/sample_source.hpp"
#include "experiments/identify/stream/streamed_identification.hpp"
#include "experiments/modal/universal_modes.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/results/report_page.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/studies/report/report.hpp"
#include "experiments/sweep/manifest.hpp"
#include "experiments/sweep/sweep_plan.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"

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
    const fs::path file = path_ / name;
    if (file.parent_path() != path_) fs::create_directories(file.parent_path());
    write_file(file, bytes);
    return file;
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

constexpr int named_ways = 3, record_ways = named_ways + 1;

/// With malformed rows refused, skipped or taken for missing; in the last way the columns say nothing of
/// themselves: the first two are times and accelerations.
template <const char* const& reader>
void read_as(const std::string& bytes, int way) {
  constexpr MalformedRows malformed[]{MalformedRows::refuse, MalformedRows::skip, MalformedRows::as_missing};
  const fs::path file = folder().write("record", bytes);
  RecordFormat format;
  format.reader = reader;
  if (way < named_ways) {
    format.malformed = malformed[way];
    format.irregular = way > 0;
  } else {
    format.sampling_rate = 100.0;
    format.channels = {{Quantity::acceleration, "", 2}};
  }
  // NaN in a file of numbers is a sample that was not read, as a gap of MiniSEED is, and as an empty cell or
  // null of a text whose columns nobody described.
  const std::string_view name = reader;
  const bool gaps = format.malformed == MalformedRows::as_missing || name == "npy" || name == "sac" ||
                    name == "tdms" || name == "miniseed" ||
                    (name == "delimited_text" && format.channels.empty());
  refusable([&] {
    const Record record = read_record(file, format);
    promise(record.size() >= 2 && record.samples.rows() == static_cast<long>(record.channels.size()) &&
            record.samples.cols() == record.size() && record.time.allFinite() &&
            (gaps ? !record.samples.array().isInf().any() : record.samples.allFinite()));
    for (long k = 1; k < record.size(); ++k) promise(record.time[k] > record.time[k - 1]);
  });
}

constexpr const char *text = "delimited_text", *lvm = "lvm", *nied = "nied", *uff58 = "uff58", *mat = "mat",
                     *hdf5 = "hdf5", *npy = "npy", *sac = "sac", *at2 = "at2", *sound = "sound",
                     *miniseed = "miniseed", *tdms = "tdms", *strong_motion = "strong_motion",
                     *spreadsheet = "spreadsheet";

/// Shapes of finite numbers at finite places, all of one size.
void read_modes(const std::string& bytes, int) {
  const fs::path file = folder().write("modes.uff", bytes);
  refusable([&] {
    holds_universal_modes(file);
    const NodalModes modes = read_universal_modes(file);
    promise(!modes.modes.empty() && modes.places.allFinite());
    for (const NodalModes::Mode& mode : modes.modes)
      promise(mode.frequency_hz > 0.0 && mode.shape.allFinite() && mode.shape.cols() == modes.places.cols());
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

void read_state(const std::string& bytes, int) {
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

void read_samples(const std::string& bytes, int) {
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

void read_experiment_file(const std::string& bytes, int) {
  refusable([&] { read_experiment(folder().write("experiment.toml", bytes)); });
}

void read_plan(const std::string& bytes, int) {
  refusable([&] {
    const auto table = TomlTable::read(folder().write("sweep.toml", bytes)).find_table("sweep");
    if (!table) return;
    const SweepPlan plan = read_sweep(*table);
    check(plan);
    for (const std::size_t number : {std::size_t{0}, plan.cases() - 1})
      promise(values_of(plan, number).size() == plan.varied.size());
  });
}

void read_journal(const std::string& bytes, int) {
  refusable([&] {
    SweepPlan plan;
    plan.varied = {parse_varied("damping.ratio=0.01,0.02"), parse_varied("beam.mass_kg=uniform:3:4")};
    plan.seeds = 4;
    const KeptCases kept = read_cases(folder().write("cases.csv", bytes), plan);
    promise(kept.size <= bytes.size());
    for (const SweepRow& row : kept.rows) promise(row.number < plan.cases());
  });
}

void read_sweep_manifest(const std::string& bytes, int) {
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
  static const fs::path second = [] {
    folder().write("b/results.json", own_results);
    return folder().write("b/report.html", own_page()).parent_path();
  }();
  folder().write("a/results.json", results);
  const fs::path first = folder().write("a/report.html", page).parent_path();
  refusable([&] { write_joined_report({first, second}, first / "joined.html", true); });
}

constexpr int page_ways = 16;  // joining takes ten times as long as reading

/// What a page is taken apart into is put together and taken apart again; in one of its ways it is joined
/// with another.
void read_page(const std::string& bytes, int way) {
  if (way == 0) return join(own_results, bytes);
  refusable([&] {
    const auto sections = sections_of(read_text(folder().write("page.html", bytes), "a page"));
    for (const ReportSection& section : sections) {
      if (!foreign_tag(section.html).empty()) return;
      command_of(section);
    }
    const auto again = sections_of(report_page(sections));
    promise(again.size() == sections.size());
    for (std::size_t i = 0; i < again.size(); ++i) promise(again[i].html == sections[i].html);
  });
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all{
      {"text", read_as<text>, record_ways},
      {"json", read_as<text>, record_ways},
      {"lvm", read_as<lvm>, record_ways},
      {"nied", read_as<nied>, record_ways},
      {"strong_motion", read_as<strong_motion>, record_ways},
      {"uff58", read_as<uff58>, named_ways},
      {"mat", read_as<mat>, record_ways},
      {"hdf5", read_as<hdf5>, record_ways},
      {"npy", read_as<npy>, record_ways},
      {"sac", read_as<sac>, record_ways},
      {"at2", read_as<at2>, record_ways},
      {"sound", read_as<sound>, record_ways},
      {"miniseed", read_as<miniseed>, record_ways},
      {"tdms", read_as<tdms>, record_ways},
      {"spreadsheet", read_as<spreadsheet>, record_ways},
      {"modes", read_modes},
      {"experiment", read_experiment_file},
      {"plan", read_plan},
      {"journal", read_journal},
      {"manifest", read_sweep_manifest},
      {"samples", read_samples},
      {"state", read_state},
      {"results", [](const std::string& bytes, int) { join(bytes, own_page()); }},
      {"page", read_page, page_ways}};
  return all;
}

}  // namespace beamid::fuzz
