#include "apps/command.hpp"

#include "experiments/config/known_names.hpp"

namespace beamid::apps {

std::string Argument::shown() const {
  return upper_case(name);
}

std::vector<Option> Command::all_options() const {
  std::vector<Option> all;
  for (const OptionGroup& group : options) all.insert(all.end(), group.options.begin(), group.options.end());
  all.insert(all.end(), common_options().begin(), common_options().end());
  return all;
}

const std::vector<CommandGroup>& command_groups() {
  static const std::vector<CommandGroup> groups{
      {"Every day",
       {modes_command(), simulate_command(), identify_command(), modal_command(), compare_command(),
        report_command()}},
      {"Records",
       {inspect_command(), prepare_command(), track_command(), backbone_command(), stream_command(),
        check_command(), steps_command(), sense_command(), substructures_command()}},
      {"Modes measured", {update_command(), twins_command(), posterior_command()}},
      {"Beams and tests to come",
       {frf_command(), frame_command(), reduce_command(), identifiability_command()}},
      {"Many runs", {sweep_command(), efficiency_command()}},
      {"Studies", study_commands()},
      {"Files and help",
       {new_command(), validate_command(), list_command(), completion_command(), help_command()}},
      {"", {man_command()}}};
  return groups;
}

const Command& find_command(const std::string& name) {
  Words known;
  for (const CommandGroup& group : command_groups())
    for (const Command& command : group.commands) {
      if (command.name == name) return command;
      if (!group.title.empty()) known.push_back(command.name);
    }
  throw UsageError("unknown command '" + name + "'; " + experiments::known_names(name, known));
}

}  // namespace beamid::apps
