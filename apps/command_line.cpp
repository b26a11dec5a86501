#include "apps/command_line.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
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

constexpr const char no_memory[] =
    "beamid: more memory was asked for than there is; expected a smaller record, mesh or ensemble\n";

/// Where nothing catches: before main(), or in what may not throw.
[[noreturn]] void end_at_once() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, no_memory, sizeof no_memory - 1);
    _exit(1);
  } catch (...) {
  }
  std::abort();
}

/// Before all else that is done before main(). A file of the largest size allowed (`ulimit -f`) is an error
/// of the write then, as a full disk is, and no signal.
[[gnu::constructor(101)]] void prepare_for_the_worst() {
  std::set_terminate(end_at_once);
  std::signal(SIGXFSZ, SIG_IGN);
}

/// Says what was wrong. Names of files and what they hold may not command a terminal.
int refuse(const char* before, const std::exception& error, const std::string& after = "") {
  std::cerr << before << experiments::clean_lines(with_suggestions(error.what()) + after) << "\n";
  return 2;
}

int print_version() {
  std::cout << "beamid " BEAMID_VERSION "\n";
  return 0;
}

int dispatch(const Words& words) {
  const std::string first = words.empty() ? "" : words[0];
  if (first.empty() || first == "--help" || first == "-h") {
    print_overview(first.empty() ? std::cerr : std::cout, terminal_page().width);
    return first.empty() ? 2 : 0;
  }
  if (first == "--version" || first == "-V") return print_version();
  const Command& command = find_command(first);
  const auto work = [&] {
    const Values values(command, {words.begin() + 1, words.end()});
    if (values.has("version")) return print_version();
    if (!values.has("help")) return command.run(values);
    print_help(std::cout, command, terminal_page().width);
    return 0;
  };
  try {
    return command.around ? command.around(work) : work();
  } catch (const UsageError& error) {
    return refuse(("beamid: " + command.name + ": ").c_str(), error,
                  "\nTry: beamid " + command.name + " --help");
  }
}

}  // namespace

int run_command_line(int count, char** words) {
  try {
    const int code = dispatch({words + 1, words + count});
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
    std::cerr << no_memory;
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
