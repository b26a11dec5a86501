#include "apps/command.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <new>
#include <sstream>
#include <system_error>

#include "apps/values.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::apps {
namespace {

/// "a, b, c" taken apart.
std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(", ", at), text.size());
    names.push_back(text.substr(at, end - at));
    at = end + 2;
  }
  return names;
}

// is the text "clamped-fre"; expected one of clamped-free, ...
std::string suggested_text(const std::string& line) {
  const std::string is = "is the text \"", list = "\"; expected one of ";
  const std::size_t from = line.find(is), to = line.find(list, from);
  if (from == std::string::npos || to == std::string::npos) return line;
  const std::size_t word = from + is.size();
  const std::string hint = suggestion(line.substr(word, to - word), listed(line.substr(to + list.size())));
  return hint.empty() ? line : line.substr(0, to + 1) + hint;
}

std::string suggested(const std::string& line) {
  constexpr const char* before = "'; known: ";
  const std::size_t unknown = line.rfind("unknown "), at = line.find(before, unknown);
  if (unknown == std::string::npos || at == std::string::npos) return suggested_text(line);
  const std::size_t quote = line.find('\'', unknown);
  if (quote >= at) return line;
  const std::vector<std::string> known = listed(line.substr(at + std::char_traits<char>::length(before)));
  return line.substr(0, at + 3) + experiments::known_names(line.substr(quote + 1, at - quote - 1), known);
}

}  // namespace

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const auto meant = experiments::nearest(word, known);
  return meant ? "; did you mean '" + *meant + "'?" : "";
}

std::string with_suggestions(const std::string& message) {
  std::istringstream lines(message);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += (result.empty() ? "" : "\n") + suggested(line);
  return result;
}

namespace {

/// Names of files and what they hold may not command a terminal.
Refusal refusal(int code, const std::string& before, const std::exception& error,
                const std::string& hint = "") {
  return {code, before + experiments::clean_lines(with_suggestions(error.what())), hint};
}

Refusal file_refusal(const std::filesystem::filesystem_error& error) {
  const std::string file = error.path2().empty() ? error.path1().string() : error.path2().string();
  return refusal(error.code() == std::errc::filename_too_long ? 2 : 1,
                 "beamid: ", std::runtime_error("'" + file + "': " + error.code().message()));
}

int print_version() {
  std::cout << "beamid " BEAMID_VERSION "\n";
  return 0;
}

int run(const Command& command, const Words& words, Receiver* receiver) {
  const auto work = [&] {
    const Values values(command, words, receiver);
    if (values.has("version")) return print_version();
    if (!values.has("help")) return command.run(values);
    print_help(std::cout, command, terminal_page().width);
    return 0;
  };
  return command.around ? command.around(work) : work();
}

int dispatch(const Words& words, std::string& reached) {
  const std::string first = words.empty() ? "" : words[0];
  if (first.empty() || first == "--help" || first == "-h") {
    print_overview(first.empty() ? std::cerr : std::cout, terminal_page().width);
    return first.empty() ? 2 : 0;
  }
  if (first == "--version" || first == "-V") return print_version();
  const Command& command = find_command(first);
  reached = first;
  return run(command, {words.begin() + 1, words.end()}, nullptr);
}

}  // namespace

Refusal described(const std::exception_ptr& failure, const std::string& command) {
  try {
    std::rethrow_exception(failure);
  } catch (const UsageError& error) {
    return refusal(2, "beamid: " + (command.empty() ? "" : command + ": "), error,
                   "Try: beamid " + (command.empty() ? "" : command + " ") + "--help");
  } catch (const experiments::InputError& error) {
    return refusal(2, "", error);
  } catch (const std::invalid_argument& error) {
    return refusal(2, "beamid: ", error);
  } catch (const std::bad_alloc&) {
    return {1, no_memory, ""};
  } catch (const std::filesystem::filesystem_error& error) {
    return file_refusal(error);
  } catch (const std::exception& error) {
    return refusal(1, "beamid: ", error);
  }
}

int run_command(const std::string& name, const std::vector<std::string>& words, Receiver& receiver) {
  return run(find_command(name), words, &receiver);
}

int run_command_line(int count, char** words) {
  std::string reached;
  try {
    const int code = dispatch({words + 1, words + count}, reached);
    std::cout.flush();
    if (!std::cout) throw std::runtime_error("standard output cannot be written");
    return code;
  } catch (...) {
    const Refusal why = described(std::current_exception(), reached);
    std::cerr << why.message << (why.hint.empty() ? "" : "\n") << why.hint << "\n";
    return why.code;
  }
}

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
      {"Start with", {inspect_command(), modal_command(), identify_command(), modes_command()}},
      {"Experiments", {simulate_command(), compare_command(), report_command()}},
      {"Records",
       {prepare_command(), track_command(), backbone_command(), stream_command(), check_command(),
        steps_command(), sense_command(), substructures_command()}},
      {"Measured modes", {update_command(), twins_command(), posterior_command()}},
      {"Models and planned tests",
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

/// A command per line; one that is too wide goes on below, behind a backslash, and can be copied as it
/// stands.
void print_examples(std::ostream& stream, const std::string& examples, std::size_t width) {
  std::istringstream lines(examples);
  for (std::string line; std::getline(lines, line);) {
    while (line.size() > width) {
      const std::size_t blank = line.rfind(" -", width - 2);
      if (blank == std::string::npos || line.find_first_not_of(' ') >= blank) break;
      stream << line.substr(0, blank) << " \\\n";
      line = "      " + line.substr(blank + 1);
    }
    stream << line << "\n";
  }
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
             "beamid " BEAMID_VERSION ": stiffness, damping and modes of structures from vibration records",
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
  stream << "\nExamples\n";
  print_examples(stream, command.examples, width);
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
