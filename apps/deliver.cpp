#include "apps/deliver.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <utility>

#include "apps/receiver.hpp"
#include "experiments/results/print.hpp"
#include "experiments/text/clean_text.hpp"

namespace beamid::apps {

namespace {

/// To the first table and what stands above it.
void shorten(experiments::Results& results) {
  const auto is_table = [](const auto& part) { return std::holds_alternative<experiments::Table>(part); };
  const auto first = std::find_if(results.report.begin(), results.report.end(), is_table);
  if (first != results.report.end()) results.report.erase(first + 1, results.report.end());
}

void warn_of_undrawn(const experiments::Results& results, const std::filesystem::path& folder) {
  const auto undrawn =
      std::count_if(results.figures.begin(), results.figures.end(), [&](const experiments::Figure& figure) {
        return !std::filesystem::exists(folder / (figure.name + ".svg"));
      });
  if (undrawn > 0)
    std::cerr
        << "beamid: warning: " << undrawn << " of " << results.figures.size()
        << " figures are not drawn: gnuplot is missing, failed or did not end ('warnings' of results.json "
           "says which; the Debian package gnuplot-nox has it). All else is written.\n";
  const auto is_missing = [&](const std::string& file) { return !std::filesystem::exists(folder / file); };
  const auto incomplete = [&](const experiments::Attachment& one) {
    return std::any_of(one.files.begin(), one.files.end(), is_missing);
  };
  if (std::any_of(results.attachments.begin(), results.attachments.end(), incomplete))
    std::cerr
        << "beamid: warning: meshes for ParaView are not written: libbeamid_vtk.so is missing or of another "
           "version (the Debian package beamid-paraview has it). All else is written.\n";
}

// What --config names, for the page: it repeats the run.
std::string experiment_text(const Values& values) {
  if (!values.has("config")) return "";
  const Words files = values.texts("config");
  std::string text;
  for (const std::string& file : files) {
    std::ifstream stream(file, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(stream), {}};
    if (files.size() > 1) text += (text.empty() ? "# " : "\n# ") + file + "\n";
    text += content;
  }
  return text;
}

}  // namespace

int deliver(const Values& values, const std::function<experiments::Results()>& find) {
  std::optional<experiments::ResultDirectory> directory;
  const bool writes = values.has("out"), quiet = values.has("quiet");
  if (writes) directory.emplace(values.text("out"), values.has("force"));

  experiments::Results results = find();
  results.command_line = values.command_line();
  results.experiment_file = experiment_text(values);
  if (!quiet && !values.receiver() && !values.has("verbose") && !values.has("no-progress")) clear_progress();
  if (directory) {
    experiments::write(results, *directory);
    warn_of_undrawn(results, directory->path());
    directory->commit();
  }
  const int code = results.has_failed() ? 3 : 0;
  if (values.receiver() != nullptr) {
    values.receiver()->take(std::move(results));
    return code;
  }
  if (values.has("json")) {
    experiments::print_json(std::cout, results);
    return code;
  }
  if (quiet) shorten(results);
  experiments::print(std::cout, results, terminal_page());
  if (quiet) return code;
  const std::string last = writes ? "Written to " + experiments::clean_text(values.text("out"))
                                  : "A page with figures, CSV tables and results.json: add --out DIR";
  std::cout << "\n";
  for (const std::string& line : experiments::wrapped(last, terminal_page().width)) std::cout << line << "\n";
  return code;
}

}  // namespace beamid::apps
