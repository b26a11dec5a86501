#include "apps/deliver.hpp"

#include <unistd.h>

#include <iostream>
#include <optional>

namespace beamid::apps {

namespace {
constexpr const char* clear_line = "\r\033[K";
}

experiments::Progress show_progress() {
  if (!isatty(STDERR_FILENO)) return [](const std::string&) {};
  return [](const std::string& what) { std::cerr << clear_line << what << " ..." << std::flush; };
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
    directory->commit();
  }
  if (values.count("json")) {
    experiments::print_json(std::cout, results);
    return;
  }
  experiments::print(std::cout, results);
  if (writes)
    std::cout << "\nWritten to " << values["out"].as<std::string>() << "\n";
  else
    std::cout << "\nA page with figures, CSV tables and results.json: add --out DIR\n";
}

}  // namespace beamid::apps
