// beamid report: what several commands found, on one page.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "apps/command.hpp"
#include "experiments/results/joined_report.hpp"
#include "experiments/results/report_pdf.hpp"
#include "experiments/text/clean_text.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;

/// Where the page is to be written: nothing must lie there yet.
fs::path new_file(const options::variables_map& values, const char* option) {
  const fs::path file = values[option].as<std::string>();
  if (fs::exists(file) && !values.count("force"))
    throw UsageError("report: " + file.string() + " exists; --force replaces it");
  return file;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()                                                                //
      ("out", options::value<std::string>()->value_name("FILE"), "the page: FILE.html")  //
      ("pdf", options::value<std::string>()->value_name("FILE"),
       "the page printed to FILE.pdf, by chromium or google-chrome")    //
      ("all", "also the numbers within lists: every run, every point")  //
      ("force", "replace FILE")                                         //
      ("help", "show this help");
  options::variables_map values;
  if (!parse(command, arguments, described, {"dir..."}, values)) return 0;
  if (!values.count("dir")) throw UsageError("report: no DIR; expected folders that --out has written");
  if (!values.count("out") && !values.count("pdf"))
    throw UsageError("report: --out FILE is missing; expected it, --pdf FILE, or both");
  std::vector<fs::path> folders;
  for (const std::string& folder : values["dir"].as<std::vector<std::string>>()) folders.emplace_back(folder);
  const fs::path pdf = values.count("pdf") ? new_file(values, "pdf") : fs::path();
  const fs::path page = values.count("out")
                            ? new_file(values, "out")
                            : fs::path(fmt::format("{}.partial-{}.html", pdf.string(), getpid()));
  if (!pdf.empty()) experiments::browser_for_pdf();
  experiments::write_joined_report(folders, page, values.count("all") > 0);
  if (!pdf.empty()) {
    const auto leave = [&] {
      std::error_code ignored;
      if (!values.count("out")) fs::remove(page, ignored);
    };
    try {
      experiments::print_pdf(page, pdf);
    } catch (...) {
      leave();
      throw;
    }
    leave();
    std::cout << "Printed to " << experiments::clean_text(pdf.string()) << "\n";
  }
  if (values.count("out"))
    std::cout << "Written to " << experiments::clean_text(page.string()) << ": open it in a browser\n";
  return 0;
}

}  // namespace

Command report_command() {
  return {"report", "DIR... --out FILE [--pdf FILE]",
          "the results of several commands on one page, side by side",
          "  beamid report results/massa1 results/massa2 --out masses.html\n"
          "  beamid report results/massa1 results/massa2 --pdf masses.pdf\n",
          run};
}

}  // namespace beamid::apps
