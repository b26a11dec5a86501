// The subcommands of `beamid`.
#pragma once

#include <boost/program_options.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace beamid::apps {

namespace options = boost::program_options;

/// Words on the command line that make no sense: printed with a hint to --help, exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One subcommand: a short file of its own.
struct Command {
  std::string name;
  std::string arguments;  ///< in the synopsis: "RECORD --config FILE"
  std::string summary;    ///< one line
  std::string examples;   ///< shown by --help, a line each
  int (*run)(const Command& command, const std::vector<std::string>& arguments);
};

/// All of them, in the order in which help shows them.
std::vector<Command> commands();

Command check_command();
Command compare_command();
Command efficiency_command();
Command frame_command();
Command frf_command();
Command identifiability_command();
Command identify_command();
Command inspect_command();
Command list_command();
Command modal_command();
Command modes_command();
Command new_command();
Command prepare_command();
Command reduce_command();
Command report_command();
Command simulate_command();
Command stream_command();
Command sweep_command();
Command track_command();
Command validate_command();
/// Every registered study is a command of its own.
std::vector<Command> study_commands();

/// The options every command that finds something has: --out, --force, --json.
options::options_description output_options();

/// Where parse() keeps the command that was given, without its output options.
inline constexpr const char* command_line_key = "the command line";

/// Parses `arguments`; with --help prints the command's help and returns false.
/// @param positional names of the words without one; "record..." takes all that are left, a vector of them
/// @throws UsageError on words that are neither options nor as many positional ones as named.
bool parse(const Command& command, const std::vector<std::string>& arguments,
           const options::options_description& described, const std::vector<std::string>& positional,
           options::variables_map& values);

}  // namespace beamid::apps
