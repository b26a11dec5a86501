// beamid report: what several commands found, on one page.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "apps/command.hpp"
#include "experiments/results/report_page.hpp"
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
  if (!values.has("out") && !values.has("pdf"))
    throw UsageError("--out FILE is missing; expected it, --pdf FILE, or both");
  const Words words = values.texts("dir");
  const std::vector<fs::path> folders(words.begin(), words.end());
  const fs::path pdf = values.has("pdf") ? new_file(values, "pdf") : fs::path();
  const fs::path page = values.has("out")
                            ? new_file(values, "out")
                            : fs::path(fmt::format("{}.partial-{}.html", pdf.string(), getpid()));
  if (!pdf.empty()) experiments::browser_for_pdf();
  experiments::write_joined_report(folders, page, values.has("all"));
  if (!pdf.empty()) {
    const auto leave = [&] {
      std::error_code ignored;
      if (!values.has("out")) fs::remove(page, ignored);
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
  if (values.has("out"))
    std::cout << "Written to " << experiments::clean_text(page.string()) << ": open it in a browser\n";
  return 0;
}

}  // namespace

Command report_command() {
  return {
      "report",
      "DIR... --out FILE [--pdf FILE]",
      "the results of several commands on one page, side by side",
      {{.name = "dir", .several = true, .required = true, .hint = "Expected folders that --out has written"}},
      {{"Options",
        {text("out", "FILE", "the page: FILE.html").as('o'),
         text("pdf", "FILE", "the page printed to FILE.pdf, by chromium or google-chrome"),
         flag("all", "also the numbers within lists: every run, every point"),
         flag("force", "replace FILE")}}},
      "  beamid report results/massa1 results/massa2 --out masses.html\n"
      "  beamid report results/massa1 results/massa2 --pdf masses.pdf\n",
      run_report};
}

}  // namespace beamid::apps
