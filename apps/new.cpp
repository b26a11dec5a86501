// beamid new: a commented experiment file to start from.
#include <filesystem>
#include <iostream>

#include "apps/command.hpp"
#include "apps/starters.hpp"
#include "experiments/results/file.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using experiments::InputError;

int run_new(const Values& values) {
  const fs::path file = values.texts("file")[0];
  const std::string starter = starter_file(values.text("structure"));
  if (file == "-") {
    std::cout << starter;
    return 0;
  }
  if (fs::is_directory(file))
    throw InputError({file.string()}, "a directory; expected the name of a new file");
  if (fs::exists(file) && !values.has("force"))
    throw InputError({file.string()}, "exists; choose another name, or replace it with --force");
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::is_directory(folder)) throw InputError({file.string()}, "no folder '" + folder.string() + "'");
  experiments::write_file(file, starter);
  std::cout << "Written: " << file.string()
            << "\nNext: put your structure and record in, then: beamid validate " << file.string() << "\n";
  return 0;
}

}  // namespace

Command new_command() {
  return {
      "new",
      "FILE [--structure KIND] [--force]",
      "a commented experiment file to start from",
      {{.name = "file", .required = true, .hint = "('-' for standard output)"}},
      {{"Options",
        {text("structure", "KIND", "what the file describes: " + experiments::joined(starter_structures()))
             .one_of(starter_structures())
             .by_default("beam"),
         flag("force", "replace a file that exists")}}},
      "  beamid new cantilever.toml\n  beamid new building.toml --structure chain\n  beamid new - | less\n",
      run_new};
}

}  // namespace beamid::apps
