#include "experiments/results/file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

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

}  // namespace beamid::experiments
