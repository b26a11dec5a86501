// beamid report: what several commands found, on one page.
#include <filesystem>
#include <iostream>

#include "apps/command.hpp"
#include "experiments/output/joined_report.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()                                                                //
      ("out", options::value<std::string>()->value_name("FILE"), "the page: FILE.html")  //
      ("force", "replace FILE")                                                          //
      ("help", "show this help");
  options::variables_map values;
  if (!parse(command, arguments, described, {"dir..."}, values)) return 0;
  if (!values.count("dir")) throw UsageError("report: no DIR; expected folders that --out has written");
  if (!values.count("out")) throw UsageError("report: --out FILE is missing");
  const fs::path file = values["out"].as<std::string>();
  if (fs::exists(file) && !values.count("force"))
    throw UsageError("report: " + file.string() + " exists; --force replaces it");
  std::vector<fs::path> folders;
  for (const std::string& folder : values["dir"].as<std::vector<std::string>>()) folders.emplace_back(folder);
  experiments::write_joined_report(folders, file);
  std::cout << "Written to " << file.string() << ": open it in a browser, print it from there to PDF\n";
  return 0;
}

}  // namespace

Command report_command() {
  return {"report", "DIR... --out FILE", "the results of several commands on one page, side by side",
          "  beamid report results/massa1 results/massa2 --out masses.html\n", run};
}

}  // namespace beamid::apps
