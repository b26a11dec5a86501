#include "apps/help.hpp"

#include <algorithm>
#include <iostream>

#include "apps/terminal.hpp"
#include "experiments/results/text.hpp"

namespace beamid::apps {
namespace {

using experiments::wrapped;

/// A term, and beside it its description; below it where the term is too long.
void print_item(std::ostream& stream, const std::string& term, const std::string& text, std::size_t column,
                std::size_t width) {
  std::string line = "  " + term;
  const std::string margin(column, ' ');
  if (line.size() + 2 > column) stream << line << "\n", line.clear();
  line.resize(column, ' ');
  const auto lines = wrapped(text, std::max<std::size_t>(width, column + 30) - column);
  for (std::size_t i = 0; i < lines.size(); ++i) stream << (i == 0 ? line : margin) << lines[i] << "\n";
}

void print_text(std::ostream& stream, const std::string& text, std::size_t width) {
  for (const std::string& line : wrapped(text, width)) stream << line << "\n";
}

int run_help(const Values& values) {
  const std::size_t width = terminal_page().width;
  if (values.has("command"))
    print_help(std::cout, find_command(values.texts("command")[0]), width);
  else
    print_overview(std::cout, width);
  return 0;
}

}  // namespace

std::string described(const Option& option) {
  std::string text = option.help;
  if (option.closed && text.find(option.choices.front()) == std::string::npos)
    text += ": " + option.expected();
  if (option.repeats) text += "; repeat for more";
  return text + (option.fallback.empty() ? "" : " [" + option.fallback + "]");
}

std::string exit_codes(const Command& command) {
  return "0  done\n1  no result: no memory, a file that cannot be written\n2  bad input or usage\n" +
         command.exit_codes;
}

void print_overview(std::ostream& stream, std::size_t width) {
  constexpr std::size_t column = 19;
  print_text(stream,
             "beamid " BEAMID_VERSION ": what a vibration record tells about a beam, and how far to trust it",
             width);
  stream << "\n  beamid COMMAND [OPTIONS]\n";
  for (const CommandGroup& group : command_groups()) {
    if (group.title.empty()) continue;
    stream << "\n" << group.title << "\n";
    for (const Command& command : group.commands)
      print_item(stream, command.name, command.summary, column, width);
  }
  stream << "\n";
  print_item(stream, "beamid help COMMAND", "options and examples of a command (beamid COMMAND -h likewise)",
             25, width);
  print_item(stream, "beamid --version, -V", "the version", 25, width);
}

void print_help(std::ostream& stream, const Command& command, std::size_t width) {
  constexpr std::size_t column = 28;
  print_text(stream, "beamid " + command.name + " " + command.arguments, width);
  stream << "\n";
  print_text(stream, command.summary, width);
  for (const OptionGroup& group : command.options) {
    stream << "\n";
    print_text(stream, group.title + ":", width);
    for (const Option& option : group.options)
      print_item(stream, option.synopsis(), described(option), column, width);
  }
  stream << "\nOf every command:\n";
  for (const Option& option : common_options())
    print_item(stream, option.synopsis(), option.help, column, width);
  stream << "\nExamples\n" << command.examples;
  if (!command.notes.empty()) stream << "\n";
  print_text(stream, command.notes, width);
  stream << "\nExit code\n";
  for (const std::string& line : wrapped(exit_codes(command), 1000))
    print_item(stream, line.substr(0, line.find(' ')), line.substr(line.find_first_not_of("0123456789 ")), 7,
               width);
}

Command help_command() {
  return {"help",
          "[COMMAND]",
          "what a command does, its options and examples",
          {{.name = "command"}},
          {},
          "  beamid help modes\n",
          run_help};
}

}  // namespace beamid::apps
