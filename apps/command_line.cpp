#include "apps/command_line.hpp"

#include <iostream>

#include "apps/command.hpp"
#include "experiments/input/input_error.hpp"

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
        std::cerr << "beamid: " << error.what() << "\nTry: beamid " << command.name << " --help\n";
        return 2;
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
    std::cerr << "beamid: " << error.what() << "\nTry: beamid --help\n";
    return 2;
  } catch (const experiments::InputError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  } catch (const std::invalid_argument& error) {
    std::cerr << "beamid: " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "beamid: " << error.what() << "\n";
    return 1;
  }
}

}  // namespace beamid::apps
