#include "experiments/sweep/manifest.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"
#include "filters/batch.hpp"

namespace beamid::experiments {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// Of a file that is not there too: cases that need it say so.
std::string hash_of_file(const fs::path& file) {
  if (!fs::exists(file)) return "not there";
  return hash_of(read_bytes(file, "a file for the cases of a sweep"));
}

/// Files that an experiment file names, in its own words, with their hashes. One that cannot be read names
/// none, and no case of it can be run.
void add_files(const ExperimentText& text, const SweepPlan& plan, Json& files) {
  Experiment experiment;
  try {
    experiment = read_experiment(TomlTable::parse(text.text, text.file.string()));
  } catch (const InputError&) {
    return;
  }
  const auto add = [&](const std::string& name) {
    if (!name.empty()) files[name] = hash_of_file(text.file.parent_path() / name);
  };
  add(experiment.excitation.file.value_or(""));
  for (const Excitation& further : experiment.further_excitations) add(further.file.value_or(""));
  add(experiment.reduction.shape_file);
  for (const Choice& reduction : experiment.reductions) add(reduction.shape_file);
  for (const VariedKey& one : plan.varied)
    if (one.key.ends_with(".file") || one.key.ends_with(".shape_file"))
      for (const filters::OptionValue& value : one.values) add(word_of(value));
}

}  // namespace

std::string hash_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return fmt::format("{:016x}", hash);
}

Json manifest_of(const SweepSource& source, const SweepPlan& plan, const Shard& shard) {
  Json json{{"program", "beamid sweep"}, {"version", BEAMID_VERSION}};
  Json& described = json["plan"];
  described["vary"] = Json::array();
  for (const VariedKey& one : plan.varied) described["vary"].push_back(one.text);
  described["random"] = plan.samples;
  described["seeds"] = plan.seeds;
  described["seed"] = plan.seed;
  if (plan.once) described["identify"] = "once";
  described["cases"] = plan.cases();
  json["experiment"] = source.config.text;
  if (source.truth) json["truth"] = source.truth->text;
  if (source.record) json["record"] = source.record->filename().string();
  Json files = Json::object();
  if (source.record) files[source.record->filename().string()] = hash_of_file(*source.record);
  add_files(source.config, plan, files);
  if (source.truth) add_files(*source.truth, plan, files);
  if (!files.empty()) json["files"] = files;
  if (plan.once) json["instructions"] = filters::batch_instructions();
  json["hash"] = hash_of(json.dump(-1, ' ', false, Json::error_handler_t::replace));
  json["shard"] = {{"index", shard.index + 1}, {"count", shard.count}};
  return json;
}

Json read_manifest(const std::filesystem::path& file) {
  Json json = read_json(file, "the manifest.json of a sweep");
  if (json.value("program", Json()) != "beamid sweep" || !json.value("hash", Json()).is_string() ||
      !json.value("shard", Json()).is_object())
    throw InputError({file.string()}, "no manifest of a sweep; expected a folder that beamid sweep wrote");
  return json;
}

SweepPlan plan_of(const Json& manifest, const std::filesystem::path& file) {
  SweepPlan plan;
  try {
    const Json& described = manifest.at("plan");
    for (const Json& text : described.at("vary"))
      plan.varied.push_back(parse_varied(text.get<std::string>()));
    const auto count = [&](const char* key) {
      return static_cast<int>(whole_number(described.at(key), key, 0, std::numeric_limits<int>::max()));
    };
    plan.samples = count("random");
    plan.seeds = count("seeds");
    if (!described.at("seed").is_number_unsigned()) throw std::invalid_argument("seed is no whole number");
    plan.seed = described.at("seed").get<std::uint64_t>();
    plan.once = described.value("identify", "") == "once";
    check(plan);
  } catch (const Json::exception&) {
    throw InputError({file.string()}, "no plan of a sweep; expected what beamid sweep wrote");
  } catch (const std::exception& error) {
    throw InputError({file.string()}, fmt::format("no plan of a sweep: {}", error.what()));
  }
  return plan;
}

namespace {

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Appears whole or not at all.
void write_whole(const fs::path& file, const std::string& text) {
  const fs::path beside = file.string() + ".new";
  write_file(beside, text);
  fs::rename(beside, file);
}

constexpr int in_use = -2;

/// The file, created if need be, opened and locked by this process alone until it is closed; -1: errno says
/// why not.
int locked_or_in_use(const fs::path& file) {
  for (;;) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
    struct stat own {
    }, there{};
    const bool locks = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    if (locks && fstat(descriptor, &own) == 0 && stat(file.c_str(), &there) == 0 &&
        own.st_ino == there.st_ino && own.st_dev == there.st_dev)
      return descriptor;
    const int reason = errno;
    ::close(descriptor);
    if (!locks && reason == EWOULDBLOCK) return in_use;
    if (!locks) {
      errno = reason;
      return -1;
    }  // else another process has removed the file in between
  }
}

/// @throws std::invalid_argument when another process works on the folder
int locked(const fs::path& file) {
  const int descriptor = locked_or_in_use(file);
  if (descriptor != in_use) return descriptor;
  throw std::invalid_argument(
      fmt::format("'{}' is in use by another beamid sweep, which is running", file.parent_path().string()));
}

}  // namespace

KeptCases read_cases(const fs::path& file, const SweepPlan& plan) {
  const std::string text = bytes_of(file), header = header_line(plan);
  KeptCases kept;
  if (!text.starts_with(header)) {
    if (text.find('\n') == std::string::npos) return kept;  // a torn header, or nothing yet
    throw InputError({file.string(), 1, 1},
                     "another header than this sweep's; expected " + header.substr(0, header.size() - 1));
  }
  kept.size = header.size();
  std::vector<SweepRow> open;  // of the case that is being read
  std::set<std::size_t> numbers;
  std::size_t line = 2;
  for (std::size_t begin = header.size(), end; (end = text.find('\n', begin)) != std::string::npos; ++line) {
    const auto row = from_line(std::string_view(text).substr(begin, end - begin), plan.varied.size());
    begin = end + 1;
    const bool follows = row && row->row == open.size() + 1 && row->row <= row->rows &&
                         row->number < plan.cases() && (open.empty() || row->number == open.front().number);
    if (!follows) throw InputError({file.string(), line, 1}, "no row of a sweep's case that belongs here");
    open.push_back(*row);
    if (open.size() < row->rows) continue;
    if (!numbers.insert(row->number).second)
      throw InputError({file.string(), line, 1}, fmt::format("case {} a second time", row->number));
    kept.rows.insert(kept.rows.end(), open.begin(), open.end());
    kept.size = begin;
    open.clear();
  }
  return kept;
}

// The lock is asked for before anything is said or changed: of a sweep that is running nothing is to be told
// but that.
Journal::Journal(const fs::path& folder, const nlohmann::ordered_json& manifest, const SweepPlan& plan,
                 bool resume)
    : folder_(folder), file_(folder / "cases.csv") {
  const fs::path described = folder / "manifest.json";
  std::error_code ignored;
  fs::create_directories(folder, ignored);  // what is wrong shows when the file is opened
  descriptor_ = locked(file_);
  if (descriptor_ < 0) fail();
  try {
    if (fs::exists(described)) {
      if (!resume)
        throw std::invalid_argument(fmt::format(
            "'{}' holds an interrupted sweep; --resume continues it, --force begins anew", folder.string()));
      const nlohmann::ordered_json found = read_manifest(described);
      if (found["hash"] != manifest["hash"] || found["shard"] != manifest["shard"])
        throw std::invalid_argument(fmt::format(
            "'{}' holds another sweep (plan {}, shard {}); expected plan {}, shard {}, with the same "
            "files, options and version",
            folder.string(), found["hash"].get<std::string>(), found["shard"].dump(),
            manifest["hash"].get<std::string>(), manifest["shard"].dump()));
    } else {
      write_whole(described,
                  manifest.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
    }
    kept_ = read_cases(file_, plan);
    if (::ftruncate(descriptor_, static_cast<off_t>(kept_.size)) != 0) fail();
    if (kept_.size == 0) write(header_line(plan));
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() {
  ::close(descriptor_);
}

void Journal::append(const std::vector<SweepRow>& rows) {
  std::string text;
  for (const SweepRow& row : rows) text += to_line(row);
  write(text);
}

void Journal::write(const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(descriptor_, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int reason = errno;
      if (::ftruncate(descriptor_, static_cast<off_t>(kept_.size)) != 0) {
      }  // the next process cuts it
      errno = reason;
      fail();
    }
    done += static_cast<std::size_t>(count);
  }
  kept_.size += text.size();
}

void Journal::fail() const {
  throw std::runtime_error(
      fmt::format("cannot write '{}': {}; finished cases are kept, --resume goes on with them",
                  file_.string(), std::strerror(errno)));
}

bool discard_journal(const fs::path& folder) {
  if (!fs::exists(folder / "manifest.json")) return true;
  read_manifest(folder / "manifest.json");  // no folder of someone else's
  const int descriptor = locked_or_in_use(folder / "cases.csv");
  if (descriptor == in_use) return false;
  std::error_code ignored;
  for (const char* name : {"cases.csv", "manifest.json", "manifest.json.new"})
    fs::remove(folder / name, ignored);
  fs::remove(folder, ignored);
  if (descriptor >= 0) ::close(descriptor);
  return true;
}

}  // namespace beamid::experiments
