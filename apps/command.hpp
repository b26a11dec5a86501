// A command of `beamid`: what it takes, stated once, and what it does with it.
#pragma once

#include <exception>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "apps/option.hpp"
#include "apps/values.hpp"

namespace beamid::apps {

// From the command line to a subcommand, and from an exception to an exit code.

// The name that was probably meant.

/// "; did you mean 'modes'?", or nothing where no name is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

/// Libraries list what they know: "unknown filter 'ufk'; known: ekf, enkf, ..., ukf". Here a name that is
/// near takes the place of a list longer than a few: "unknown filter 'ufk'; did you mean 'ukf'?". Line by
/// line.
std::string with_suggestions(const std::string& message);

class Receiver;

/// What is said where memory ends.
inline constexpr char no_memory[] =
    "beamid: more memory was requested than there is; expected a smaller record, mesh or ensemble";

/// The whole of `beamid`, with every method that is registered in the program that calls it; its exit code:
///
///     0  success (a filter that diverged is a result)     1  failure with nothing usable     2  bad input
///
/// Throws nothing: what went wrong is told on standard error.
int run_command_line(int count, char** words);

/// One command for a program around it: what it finds goes to the receiver, what it otherwise prints to
/// standard output, and an exception means what described() says. Its exit code.
/// @param words behind the command's name
int run_command(const std::string& name, const std::vector<std::string>& words, Receiver& receiver);

/// Why a command ended without results.
struct Refusal {
  int code = 1;         ///< 2: bad input
  std::string message;  ///< clean lines, with the name that was probably meant
  std::string hint;     ///< "Try: beamid modes --help"; empty: none
};

/// What an exception of a command means. @param command empty: none was reached
Refusal described(const std::exception_ptr& failure, const std::string& command);

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

/// Commands under one heading of the first screen.
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

// What a command says of itself.

/// All commands, a line each. @param width of the terminal
void print_overview(std::ostream& stream, std::size_t width);

/// One of them: its synopsis, options with their defaults, examples, exit codes.
void print_help(std::ostream& stream, const Command& command, std::size_t width);

/// "how many, the lowest [10]"
std::string described(const Option& option);

/// "0  done\n1  ...\n": of every command, and the command's own.
std::string exit_codes(const Command& command);

}  // namespace beamid::apps
