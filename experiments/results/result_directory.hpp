// A folder of results that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace beamid::experiments {

// Files written so that a failure is noticed.

/// Writes a whole file, replacing what was there.
/// @throws std::runtime_error naming the file and the system's reason (read-only, no space left, ...).
void write_file(const std::filesystem::path& file, std::string_view text);

/// The same of a file that is always whole: the new text is written beside it, to the disk itself, and takes
/// its place in one step. What killed processes have left beside it is removed. A link there is replaced, not
/// followed.
void replace_file(const std::filesystem::path& file, std::string_view text);

/// @throws std::runtime_error where replace_file() could not put anything, so that it is known before the
/// work.
void require_writable(const std::filesystem::path& file);

/// Files and folders named `prefix` and the number of a process that has ended.
std::vector<std::filesystem::path> abandoned(const std::filesystem::path& parent, const std::string& prefix);

/// Files are written beside the folder, into ".NAME.partial-PID", and take its place when committed. Without
/// a commit nothing is left behind.
///
///     ResultDirectory directory("out", force);
///     directory.write("notes.txt", text);
///     write(figure, directory.path());
///     directory.commit();
///
/// `force` replaces earlier results and nothing else: the folder must hold a results.json of beamid, and only
/// files that its "files" list names (results.hpp).
class ResultDirectory {
 public:
  /// Checks at once what could only fail after hours of work, and creates nothing yet.
  /// @throws std::invalid_argument when the folder is not empty (without `force`), holds what beamid did not
  /// write,
  ///         is a file, the current folder or one above it, or a mount point.
  /// @throws std::runtime_error when it cannot be written.
  ResultDirectory(const std::filesystem::path& destination, bool force);
  ~ResultDirectory();
  ResultDirectory(const ResultDirectory&) = delete;
  ResultDirectory& operator=(const ResultDirectory&) = delete;

  /// Where files are to be written until the commit; created by the first call.
  /// @throws std::runtime_error when it cannot be created.
  const std::filesystem::path& path();

  /// Writes one file. @throws std::runtime_error naming it and the system's reason.
  void write(const std::string& name, std::string_view text);

  /// Puts the files in their place, all at once. To be called once.
  /// @throws std::invalid_argument when the folder has meanwhile got contents that may not be replaced.
  /// @throws std::runtime_error naming the folder and the system's reason.
  void commit();

 private:
  std::filesystem::path given_;        // as the user wrote it, for messages
  std::filesystem::path destination_;  // absolute
  std::filesystem::path staging_;
  std::filesystem::path created_;  // topmost folder above the destination that did not exist
  bool force_ = false, staged_ = false, committed_ = false;

  void check_replaceable() const;
};

}  // namespace beamid::experiments
