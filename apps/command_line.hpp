// From the command line to a subcommand, and from an exception to an exit code.
#pragma once

#include <exception>
#include <string>
#include <vector>

namespace beamid::apps {

class Receiver;

/// What is said where memory ends.
inline constexpr char no_memory[] =
    "beamid: more memory was asked for than there is; expected a smaller record, mesh or ensemble";

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

}  // namespace beamid::apps
