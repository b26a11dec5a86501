// Every registered study as a command: its options are the command's.
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"

namespace beamid::apps {
namespace {

using experiments::study_registry;

std::string option_name(std::string name) {  // first_guess -> first-guess
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

Option option_of(const filters::OptionSpec& spec) {
  const std::string name = option_name(spec.name),
                    help = spec.description + (spec.unit.empty() ? "" : " [" + spec.unit + "]");
  if (const double* fallback = std::get_if<double>(&spec.fallback))
    return number(name, "N", help).by_default(fmt::format("{}", *fallback));
  const Option option = text(name, name == "config" ? "FILE" : "NAME", help);
  return (name == "config" ? option.as('c') : option).by_default(std::get<std::string>(spec.fallback));
}

int run_study(const Values& values) {
  filters::Options chosen;
  for (const auto& spec : study_registry().find(values.command().name).options) {
    const std::string name = option_name(spec.name);
    if (std::holds_alternative<double>(spec.fallback))
      chosen.set(spec.name, values.number(name));
    else
      chosen.set(spec.name, values.text(name));
  }
  const auto ready = study_registry().make(values.command().name, chosen);
  return deliver(values, [&] { return ready->run(show_progress(values)); });
}

}  // namespace

std::vector<Command> study_commands() {
  std::vector<Command> result;
  for (const auto& [name, entry] : study_registry().entries()) {
    OptionGroup own{"Options", {}};
    for (const auto& spec : entry.options) own.options.push_back(option_of(spec));
    result.push_back({name,
                      "[OPTIONS] [--out DIR]",
                      entry.summary,
                      {},
                      {own, output_options()},
                      "  beamid " + name + "\n  beamid " + name + " --out results\n  beamid " + name +
                          " --json | python3 -m json.tool\n",
                      run_study});
  }
  return result;
}

}  // namespace beamid::apps
