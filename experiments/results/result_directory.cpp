#include "experiments/results/result_directory.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

namespace beamid::experiments {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_write(const fs::path& file) {
  throw std::runtime_error("cannot write '" + file.string() + "': " + std::strerror(errno));
}

fs::path parent_folder(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Also where its parent has not yet taken notice.
bool has_ended(pid_t process) {
  if (kill(process, 0) != 0) return errno == ESRCH;
  std::ifstream stream(fmt::format("/proc/{}/stat", process));
  std::string line;  // "21127 (beamid) Z 1 ..."
  std::getline(stream, line);
  const std::size_t name_end = line.rfind(") ");
  return name_end != std::string::npos && (line[name_end + 2] == 'Z' || line[name_end + 2] == 'X');
}

void write_text(const fs::path& file, std::string_view text, bool to_disk) {
  std::FILE* const stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) fail_to_write(file);
  bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if (to_disk) written = written && std::fflush(stream) == 0 && fsync(fileno(stream)) == 0;
  const int reason = errno;
  // A full disk often shows only here, when the buffer is flushed.
  const bool closed = std::fclose(stream) == 0;
  if (!written) errno = reason;
  if (!written || !closed) fail_to_write(file);
}

}  // namespace

void write_file(const fs::path& file, std::string_view text) {
  write_text(file, text, false);
}

void replace_file(const fs::path& file, std::string_view text) {
  const std::string prefix = file.filename().string() + ".partial-";
  std::error_code ignored;
  for (const fs::path& left : abandoned(parent_folder(file), prefix)) fs::remove(left, ignored);
  const fs::path beside = parent_folder(file) / (prefix + std::to_string(getpid()));
  fs::remove(beside, ignored);  // a link there would be followed
  try {
    write_text(beside, text, true);
    if (std::rename(beside.c_str(), file.c_str()) != 0) fail_to_write(file);
  } catch (...) {
    fs::remove(beside, ignored);
    throw;
  }
}

void require_writable(const fs::path& file) {
  if (access(parent_folder(file).c_str(), W_OK | X_OK) != 0) fail_to_write(file);
}

std::vector<fs::path> abandoned(const fs::path& parent, const std::string& prefix) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(parent, ignored)) {
    const std::string name = entry.path().filename().string();
    const char* const end = name.data() + name.size();
    pid_t process = 0;
    if (name.starts_with(prefix) && std::from_chars(name.data() + prefix.size(), end, process).ptr == end &&
        process > 0 && has_ended(process))
      found.push_back(entry.path());
  }
  return found;
}

namespace {

fs::path resolved(const fs::path& given) {
  if (given.empty()) throw std::invalid_argument("output folder '': expected a name");
  fs::path path = fs::weakly_canonical(fs::absolute(given));
  return path.has_filename() ? path : path.parent_path();
}

fs::path nearest_existing(fs::path path) {
  while (!fs::exists(path)) path = path.parent_path();
  return path;
}

std::string staging_prefix(const fs::path& destination) {
  return "." + destination.filename().string() + ".partial-";
}

bool is_mount_point(const fs::path& folder) {
  struct stat own {
  }, above{};
  return stat(folder.c_str(), &own) == 0 && stat(folder.parent_path().c_str(), &above) == 0 &&
         (own.st_dev != above.st_dev || own.st_ino == above.st_ino);
}

// The files that earlier results consist of; empty where the folder holds no results of beamid.
std::set<std::string> earlier_results(const fs::path& folder) {
  std::ifstream stream(folder / "results.json");
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object() || json.value("program", nlohmann::json()) != "beamid") return {};
  std::set<std::string> files{"results.json"};
  if (const auto list = json.find("files"); list != json.end() && list->is_array())
    for (const auto& file : *list)
      if (file.is_string()) files.insert(file.get<std::string>());
  return files;
}

// Swaps two folders; false, with errno set, when that fails and both are where they were.
bool exchange(const fs::path& one, const fs::path& other) {
  if (renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // Network file systems cannot do it in one step.
  const fs::path aside = one.string() + ".old";
  if (std::rename(other.c_str(), aside.c_str()) != 0) return false;
  if (std::rename(one.c_str(), other.c_str()) == 0) return std::rename(aside.c_str(), one.c_str()) == 0;
  const int failure = errno;
  std::rename(aside.c_str(), other.c_str());
  errno = failure;
  return false;
}

// Locks that this process holds on its staging folders, of which the system frees it however it ends.
struct StagingLocks {
  std::mutex one_at_a_time;  // results may be written by several threads
  std::map<fs::path, int> held;
};

StagingLocks& staging_locks() {
  static StagingLocks locks;
  return locks;
}

int open_locked(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0 || flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  close(descriptor);
  return -1;
}

void keep_locked(const fs::path& folder) {
  auto& [one_at_a_time, held] = staging_locks();
  const std::lock_guard guard(one_at_a_time);
  if (const int lock = open_locked(folder); lock >= 0) held.insert_or_assign(folder, lock);
}

void unlock(const fs::path& folder) {
  auto& [one_at_a_time, held] = staging_locks();
  const std::lock_guard guard(one_at_a_time);
  if (const auto lock = held.find(folder); lock != held.end()) {
    close(lock->second);
    held.erase(lock);
  }
}

// Removes what processes have left that ended before their commit: folders named `prefix` and the process.
void clear_abandoned(const fs::path& parent, const std::string& prefix) {
  std::error_code ignored;
  for (const fs::path& folder : abandoned(parent, prefix)) {
    const int lock = open_locked(folder);  // not of a process of another machine or container
    if (lock < 0) continue;
    fs::remove_all(folder, ignored);
    close(lock);
  }
}

std::string reason() {
  return std::strerror(errno);
}

}  // namespace

ResultDirectory::ResultDirectory(const fs::path& destination, bool force)
    : given_(destination), destination_(resolved(destination)), force_(force) {
  const std::string name = "output folder '" + given_.string() + "'";
  if (fs::exists(destination_) && !fs::is_directory(destination_))
    throw std::invalid_argument(name + " is a file; expected a folder or a new name");
  const fs::path here = fs::current_path(), parent = destination_.parent_path();
  if (std::mismatch(destination_.begin(), destination_.end(), here.begin(), here.end()).first ==
      destination_.end())
    throw std::invalid_argument(
        name + " holds the current folder; expected another one, which can be replaced whole");
  if (fs::exists(destination_) && is_mount_point(destination_))
    throw std::invalid_argument(name +
                                " is a mount point and cannot be replaced; expected a folder within it");
  check_replaceable();
  const fs::path existing = nearest_existing(parent);
  if (!fs::is_directory(existing))
    throw std::invalid_argument(name + ": '" + existing.string() + "' is a file; expected a folder");
  if (access(existing.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error("cannot write " + name + ": '" + existing.string() + "': " + reason());
  staging_ = parent / fmt::format("{}{}", staging_prefix(destination_), getpid());
}

ResultDirectory::~ResultDirectory() {
  std::error_code ignored;  // nothing better can be done on the way out
  if (staged_) fs::remove_all(staging_, ignored);
  unlock(staging_);
  if (committed_ || created_.empty()) return;
  // Folders made on the way to the destination go as well, as far as they are empty.
  for (fs::path folder = destination_.parent_path(); fs::remove(folder, ignored) && folder != created_;)
    folder = folder.parent_path();
}

void ResultDirectory::check_replaceable() const {
  if (!fs::exists(destination_) || fs::is_empty(destination_)) return;
  const std::string name = "output folder '" + given_.string() + "'";
  if (!force_)
    throw std::invalid_argument(name +
                                " is not empty; choose another one, or replace its results with --force");
  const std::set<std::string> files = earlier_results(destination_);
  if (files.empty())
    throw std::invalid_argument(name +
                                " holds no results.json of beamid; --force replaces only earlier results");
  for (const auto& entry : fs::directory_iterator(destination_))
    if (entry.symlink_status().type() != fs::file_type::regular ||
        !files.contains(entry.path().filename().string()))
      throw std::invalid_argument(name + " also holds '" + entry.path().filename().string() +
                                  "', which beamid did not write; move it away, or choose another folder");
}

const fs::path& ResultDirectory::path() {
  if (staged_) return staging_;
  const fs::path parent = destination_.parent_path();
  try {
    fs::path missing = parent;
    while (!fs::exists(missing)) created_ = std::exchange(missing, missing.parent_path());
    fs::create_directories(parent);
    fs::remove_all(staging_);  // of a killed process that had the same number
    clear_abandoned(parent, staging_prefix(destination_));
    fs::create_directory(staging_);
    keep_locked(staging_);
    if (fs::exists(destination_)) fs::permissions(staging_, fs::status(destination_).permissions());
  } catch (const fs::filesystem_error& error) {
    throw std::runtime_error("cannot write output folder '" + given_.string() +
                             "': " + error.code().message());
  }
  staged_ = true;
  return staging_;
}

void ResultDirectory::write(const std::string& name, std::string_view text) {
  write_file(path() / name, text);
}

void ResultDirectory::commit() {
  path();
  check_replaceable();
  const auto fail = [&] {
    throw std::runtime_error("cannot write output folder '" + given_.string() + "': " + reason());
  };
  // A rename puts the new folder in the place of none or of an empty one, and fails on any other.
  if (std::rename(staging_.c_str(), destination_.c_str()) != 0) {
    if ((errno != ENOTEMPTY && errno != EEXIST) || !force_) fail();
    if (!exchange(staging_, destination_)) fail();
  } else {
    staged_ = false;
  }
  // After an exchange the staging folder holds the old results, which the destructor removes.
  committed_ = true;
}

}  // namespace beamid::experiments
