#include "apps/deliver.hpp"

#include <unistd.h>

#include <algorithm>
#include <boost/any.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>

#include "experiments/text/clean_text.hpp"

namespace beamid::apps {

namespace {

constexpr const char* clear_line = "\r\033[K";

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
}

// What --config names, for the page: it repeats the run.
std::string experiment_text(const options::variables_map& values) {
  if (!values.count("config")) return "";
  const auto& given = values["config"].value();
  std::vector<std::string> files;
  if (const auto* one = boost::any_cast<std::string>(&given)) files = {*one};
  if (const auto* many = boost::any_cast<std::vector<std::string>>(&given)) files = *many;
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

experiments::Progress show_progress() {
  if (!isatty(STDERR_FILENO)) return [](const std::string&) {};
  return [](const std::string& what) {
    std::cerr << clear_line << experiments::clean_text(what) << " ..." << std::flush;
  };
}

void deliver(const options::variables_map& values, const std::function<experiments::Results()>& find) {
  std::optional<experiments::ResultDirectory> directory;
  const bool writes = values.count("out") > 0;
  if (writes) directory.emplace(values["out"].as<std::string>(), values.count("force") > 0);

  experiments::Results results = find();
  results.command_line = values[command_line_key].as<std::string>();
  results.experiment_file = experiment_text(values);
  if (isatty(STDERR_FILENO)) std::cerr << clear_line;
  if (directory) {
    experiments::write(results, *directory);
    warn_of_undrawn(results, directory->path());
    directory->commit();
  }
  if (values.count("json")) {
    experiments::print_json(std::cout, results);
    return;
  }
  experiments::print(std::cout, results);
  if (writes)
    std::cout << "\nWritten to " << experiments::clean_text(values["out"].as<std::string>()) << "\n";
  else
    std::cout << "\nA page with figures, CSV tables and results.json: add --out DIR\n";
}

}  // namespace beamid::apps
