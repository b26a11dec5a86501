// What a command says of itself.
#pragma once

#include <ostream>
#include <string>

#include "apps/command.hpp"

namespace beamid::apps {

/// All commands, a line each. @param width of the terminal
void print_overview(std::ostream& stream, std::size_t width);

/// One of them: its synopsis, options with their defaults, examples, exit codes.
void print_help(std::ostream& stream, const Command& command, std::size_t width);

/// "how many, the lowest [10]"
std::string described(const Option& option);

/// "0  done\n1  ...\n": of every command, and the command's own.
std::string exit_codes(const Command& command);

}  // namespace beamid::apps
