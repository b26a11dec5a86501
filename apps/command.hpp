// A command of `beamid`: what it takes, stated once, and what it does with it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/option.hpp"
#include "apps/values.hpp"

namespace beamid::apps {

/// A word that is no option.
struct Argument {
  std::string name;      ///< under which Values has it: "record"
  bool several = false;  ///< all that are left
  bool required = false;
  std::string hint = {};  ///< said where it is missing
  Words choices = {};     ///< for completion; without any, files

  std::string shown() const;  ///< "RECORD"
};

/// One subcommand: a short file of its own.
struct Command {
  std::string name;
  std::string arguments;  ///< in the synopsis: "RECORD --config FILE"
  std::string summary;    ///< one line
  std::vector<Argument> words;
  std::vector<OptionGroup> options;
  std::string examples;  ///< a line each
  int (*run)(const Values& values);
  std::string notes = {};       ///< paragraphs below the examples
  std::string exit_codes = {};  ///< beyond those of every command: "3  the filter diverged\n"
  /// What surrounds the reading of the words and the run, where something does; it calls `work` once, or not.
  int (*around)(const std::function<int()>& work) = nullptr;

  /// Its own, then --help and --version.
  std::vector<Option> all_options() const;
};

struct CommandGroup {
  std::string title;  ///< empty: not shown in the help
  std::vector<Command> commands;
};

/// All of them, in the order in which help shows them.
const std::vector<CommandGroup>& command_groups();

/// @throws UsageError "unknown command 'mods'; did you mean 'modes'?"
const Command& find_command(const std::string& name);

Command backbone_command();
Command check_command();
Command compare_command();
Command completion_command();
Command efficiency_command();
Command frame_command();
Command frf_command();
Command help_command();
Command identifiability_command();
Command identify_command();
Command inspect_command();
Command list_command();
Command man_command();
Command modal_command();
Command modes_command();
Command new_command();
Command posterior_command();
Command prepare_command();
Command reduce_command();
Command report_command();
Command sense_command();
Command simulate_command();
Command steps_command();
Command stream_command();
Command substructures_command();
Command sweep_command();
Command track_command();
Command twins_command();
Command update_command();
Command validate_command();
/// Every registered study is a command of its own.
std::vector<Command> study_commands();

}  // namespace beamid::apps
