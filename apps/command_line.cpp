#include "apps/command_line.hpp"

#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "apps/command.hpp"
#include "experiments/text/clean_text.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::apps {
namespace {

void print_help(std::ostream& stream) {
  stream << "beamid " BEAMID_VERSION
            ": what a vibration record tells about a beam, and how far to trust it\n\n"
            "  beamid COMMAND [OPTIONS]\n\nCommands\n";
  for (const Command& command : commands()) {
    std::string name = command.name;
    name.resize(17, ' ');
    stream << "  " << name << command.summary << "\n";
  }
  stream << "\n  beamid COMMAND --help   options and examples of a command\n"
            "  beamid --version        the version\n";
}

/// Says what was wrong. Names of files and what they hold may not command a terminal.
int refuse(const char* before, const std::exception& error, const std::string& after = "") {
  std::cerr << before << experiments::clean_lines(error.what() + after) << "\n";
  return 2;
}

int run(const std::vector<std::string>& words) {
  if (words.empty() || words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
    print_help(words.empty() ? std::cerr : std::cout);
    return words.empty() ? 2 : 0;
  }
  if (words[0] == "--version") {
    std::cout << "beamid " BEAMID_VERSION "\n";
    return 0;
  }
  std::string known;
  for (const Command& command : commands()) {
    if (command.name == words[0]) {
      try {
        return command.run(command, {words.begin() + 1, words.end()});
      } catch (const UsageError& error) {
        return refuse("beamid: ", error, "\nTry: beamid " + command.name + " --help");
      }
    }
    known += (known.empty() ? "" : ", ") + command.name;
  }
  throw UsageError("unknown command '" + words[0] + "'; known: " + known);
}

}  // namespace

int run_command_line(int count, char** words) {
  try {
    const int code = run({words + 1, words + count});
    std::cout.flush();
    if (!std::cout) throw std::runtime_error("standard output cannot be written");
    return code;
  } catch (const UsageError& error) {
    return refuse("beamid: ", error, "\nTry: beamid --help");
  } catch (const experiments::InputError& error) {
    return refuse("", error);
  } catch (const std::invalid_argument& error) {
    return refuse("beamid: ", error);
  } catch (const std::bad_alloc&) {
    std::cerr
        << "beamid: more memory was asked for than there is; expected a smaller record, mesh or ensemble\n";
    return 1;
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string file = error.path2().empty() ? error.path1().string() : error.path2().string();
    refuse("beamid: ", std::runtime_error("'" + file + "': " + error.code().message()));
    return error.code() == std::errc::filename_too_long ? 2 : 1;
  } catch (const std::exception& error) {
    refuse("beamid: ", error);
    return 1;
  }
}

}  // namespace beamid::apps
