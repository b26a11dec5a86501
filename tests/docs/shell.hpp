// Commands as a user types them, in a copy of the documentation that is removed afterwards.
#pragma once

#include "tests/apps/run_command.hpp"

namespace beamid::docs {

namespace fs = std::filesystem;
using apps::Outcome, apps::contents, apps::source;

/// Set by tests/golden/update: what is found becomes golden, and the lines of pages.
inline bool updating() {
  return std::getenv("BEAMID_UPDATE_GOLDEN") != nullptr;
}

/// README.md and docs/ in a temporary folder, and a POSIX shell there that finds beamid.
class Shell {
 public:
  Shell() {
    for (const char* name : {"README.md", "docs"})
      fs::copy(source(name), place_.folder() / name, fs::copy_options::recursive);
  }

  fs::path root() const { return place_.folder(); }

  /// One line or several, in a folder below root().
  Outcome run(const std::string& lines, const std::string& folder = ".") const {
    const fs::path out = place_.folder() / ".stdout", err = place_.folder() / ".stderr",
                   script = place_.folder() / ".script";
    std::ofstream(script) << "PATH='" << fs::path(BEAMID_COMMAND).parent_path().string()
                          << "':$PATH LC_ALL=C NO_COLOR=1\nexport PATH LC_ALL NO_COLOR\nunset COLUMNS\n"
                          << lines << "\n";
    const std::string call = "cd '" + (place_.folder() / folder).string() + "' && sh '" + script.string() +
                             "' >'" + out.string() + "' 2>'" + err.string() + "' </dev/null";
    const int status = std::system(call.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out), contents(err)};
  }

 private:
  apps::Workplace place_;
};

}  // namespace beamid::docs
