// From the command line to a subcommand, and from an exception to an exit code.
#pragma once

namespace beamid::apps {

/// The whole of `beamid`, with every method that is registered in the program that calls it; its exit code:
///
///     0  success (a filter that diverged is a result)     1  failure with nothing usable     2  bad input
///
/// Throws nothing: what went wrong is told on standard error.
int run_command_line(int count, char** words);

}  // namespace beamid::apps
