// The real executable, run as a user runs it, in a folder that is removed afterwards.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace beamid::apps {

namespace fs = std::filesystem;

std::string contents(const fs::path& file);

struct Outcome {
  int code = -1;  ///< -1: did not exit by itself
  std::string out, err;

  std::string first_error_line() const { return err.substr(0, err.find('\n')); }
};

/// A temporary working folder, and the command run in it. Standard output and error go to files outside it,
/// so that files() shows only what the command wrote.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  fs::path folder() const { return root_ / "here"; }

  void write(const std::string& name, const std::string& text) const;

  /// beamid with these words of a POSIX shell, in an environment changed as in "PATH=/nowhere".
  Outcome run(const std::string& words, const std::string& environment = "") const;

  /// Names of all that lies in the folder, hidden and nested files too, sorted.
  std::vector<std::string> files() const;

 private:
  fs::path root_;
};

/// What standard output holds, where the command succeeded.
nlohmann::json json_of(const Outcome& outcome);

/// A path in the source tree.
fs::path source(const std::string& path);

}  // namespace beamid::apps
