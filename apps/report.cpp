// beamid report: what several commands found, on one page.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "apps/command.hpp"
#include "experiments/results/process.hpp"
#include "experiments/studies/report/report.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;

/// Where the page is to be written: nothing must lie there yet.
fs::path new_file(const Values& values, const char* option) {
  fs::path file = values.text(option);
  if (fs::exists(file) && !values.has("force"))
    throw UsageError(file.string() + " exists; --force replaces it");
  return file;
}

int run_report(const Values& values) {
  if (!values.has("out") && !values.has("pdf") && !values.has("png"))
    throw UsageError("--out FILE is missing; expected it, --pdf FILE, or both");
  if (values.has("png") && fs::path(values.text("png")).extension() != ".png")
    throw UsageError("--png is '" + values.text("png") + "'; expected a name that ends in .png");
  const Words words = values.texts("dir");
  const std::vector<fs::path> folders(words.begin(), words.end());
  std::vector<fs::path> printed;
  for (const char* option : {"pdf", "png"})
    if (values.has(option)) printed.push_back(new_file(values, option));
  const fs::path page = values.has("out")
                            ? new_file(values, "out")
                            : fs::path(fmt::format("{}.partial-{}.html", printed[0].string(), getpid()));
  if (!printed.empty()) experiments::browser_on_path();
  experiments::write_joined_report(folders, page, values.has("all"));
  if (!printed.empty()) {
    const auto leave = [&] {
      std::error_code ignored;
      if (!values.has("out")) fs::remove(page, ignored);
    };
    try {
      for (const fs::path& file : printed) experiments::print_page(page, file);
    } catch (...) {
      leave();
      throw;
    }
    leave();
    for (const fs::path& file : printed)
      std::cout << "Printed to " << experiments::clean_text(file.string()) << "\n";
  }
  if (values.has("out"))
    std::cout << "Written to " << experiments::clean_text(page.string()) << ": open it in a browser\n";
  return 0;
}

}  // namespace

Command report_command() {
  return {
      "report",
      "DIR... --out FILE [--pdf FILE] [--png FILE]",
      "the results of several commands on one page, side by side",
      {{.name = "dir", .several = true, .required = true, .hint = "Expected folders that --out has written"}},
      {{"Options",
        {text("out", "FILE", "the page: FILE.html").as('o'),
         text("pdf", "FILE", "the page printed to FILE.pdf, by chromium or google-chrome"),
         text("png", "FILE", "the beginning of the page, 960 x 928 pixels, as FILE.png, by the same"),
         flag("all", "also the numbers within lists: every run, every point"),
         flag("force", "replace FILE")}}},
      "  beamid report results/massa1 results/massa2 --out masses.html\n"
      "  beamid report results/massa1 results/massa2 --pdf masses.pdf\n",
      run_report};
}

}  // namespace beamid::apps
