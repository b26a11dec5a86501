// Every registered study as a command: its options are the command's.
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include "apps/deliver.hpp"

namespace beamid::apps {
namespace {

using experiments::study_registry;

std::string flag(std::string name) {  // first_guess -> first-guess
  for (char& letter : name)
    if (letter == '_') letter = '-';
  return name;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  const auto& study = study_registry().find(command.name);
  options::options_description described("Options");
  for (const auto& option : study.options) {
    const std::string help = option.description + (option.unit.empty() ? "" : " [" + option.unit + "]");
    if (const double* number = std::get_if<double>(&option.fallback))
      described.add_options()(
          flag(option.name).c_str(),
          options::value<double>()->default_value(*number, fmt::format("{}", *number))->value_name("N"),
          help.c_str());
    else
      described.add_options()(flag(option.name).c_str(),
                              options::value<std::string>()
                                  ->default_value(std::get<std::string>(option.fallback))
                                  ->value_name("NAME"),
                              help.c_str());
  }
  described.add(output_options());
  options::variables_map values;
  if (!parse(command, arguments, described, {}, values)) return 0;

  filters::Options chosen;
  for (const auto& option : study.options) {
    const auto& value = values[flag(option.name)];
    if (std::holds_alternative<double>(option.fallback))
      chosen.set(option.name, value.as<double>());
    else
      chosen.set(option.name, value.as<std::string>());
  }
  const auto ready = study_registry().make(command.name, chosen);
  deliver(values, [&] { return ready->run(show_progress()); });
  return 0;
}

}  // namespace

std::vector<Command> study_commands() {
  std::vector<Command> result;
  for (const auto& [name, entry] : study_registry().entries())
    result.push_back({name, "[OPTIONS] [--out DIR]", entry.summary,
                      "  beamid " + name + "\n  beamid " + name + " --out results\n  beamid " + name +
                          " --json | python3 -m json.tool\n",
                      run});
  return result;
}

}  // namespace beamid::apps
