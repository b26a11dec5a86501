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

inline std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + " cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Outcome {
  int code = -1;  ///< -1: did not exit by itself
  std::string out, err;

  std::string first_error_line() const { return err.substr(0, err.find('\n')); }
};

/// A temporary working folder, and the command run in it. Standard output and error go to files outside it,
/// so that files() shows only what the command wrote.
class Workplace {
 public:
  Workplace() {
    std::string name = (fs::temp_directory_path() / "beamid_apps_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    root_ = name;
    fs::create_directory(folder());
  }
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  fs::path folder() const { return root_ / "here"; }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder() / name, std::ios::binary) << text;
  }

  /// beamid with these words of a POSIX shell, in an environment changed as in "PATH=/nowhere".
  Outcome run(const std::string& words, const std::string& environment = "") const {
    const fs::path out = root_ / "stdout", err = root_ / "stderr";
    const std::string line = "cd '" + folder().string() + "' && " + environment + " '" BEAMID_COMMAND "' " +
                             words + " >'" + out.string() + "' 2>'" + err.string() + "' </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out), contents(err)};
  }

  /// Names of all that lies in the folder, hidden and nested files too, sorted.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder()))
      names.push_back(entry.path().lexically_relative(folder()).string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  fs::path root_;
};

inline fs::path source(const std::string& path) {
  return fs::path(BEAMID_SOURCE_DIR) / path;
}

}  // namespace beamid::apps
