// A folder of results that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace beamid::experiments {

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
