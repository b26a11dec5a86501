#include "apps/command_line.hpp"

#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "apps/command.hpp"
#include "apps/help.hpp"
#include "apps/suggestion.hpp"
#include "apps/terminal.hpp"
#include "experiments/text/clean_text.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::apps {
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

}  // namespace beamid::apps
