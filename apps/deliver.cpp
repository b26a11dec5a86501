#include "apps/deliver.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
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
