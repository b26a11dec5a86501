#include "apps/deliver.hpp"

#include <iostream>
#include <optional>

namespace beamid::apps {

void deliver(const options::variables_map& values, const std::function<experiments::Results()>& find) {
  std::optional<experiments::ResultDirectory> directory;
  const bool writes = values.count("out") > 0;
  if (writes) directory.emplace(values["out"].as<std::string>(), values.count("force") > 0);

  const experiments::Results results = find();
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
    std::cout << "\nFigures, CSV tables and results.json: add --out DIR\n";
}

}  // namespace beamid::apps
