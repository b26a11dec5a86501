// What stands on the command line, checked against the options of its command.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "apps/option.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::apps {

struct Command;
class Receiver;

/// Words on the command line that make no sense: printed after the command's name and with a hint to its
/// --help, exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the command line gives for the options and arguments of a command.
class Values {
 public:
  /// Long options as --name VALUE or --name=VALUE, short ones as -n VALUE or -nVALUE, flags joined as in -qv;
  /// behind "--" nothing is an option. Numbers are no options either, so that values may be negative.
  ///
  /// --help and --version end the reading: what stands behind them is not looked at.
  /// @param command lives longer.
  /// @param receiver of what is found, where that is a program and no terminal; lives longer
  /// @throws UsageError on an option that the command does not have, with the one that was probably meant, on
  ///     values that are missing, of the wrong type or out of range, on words too many or too few.
  Values(const Command& command, const Words& words, Receiver* receiver = nullptr);

  /// Whether the option, or a word of this name, is on the command line.
  bool has(const std::string& name) const { return given_.contains(name); }
  /// Its value, the last of several, or its default.
  const std::string& text(const std::string& name) const;
  Words texts(
      const std::string& name) const;  ///< all of them; empty where it is neither given nor has a default
  double number(const std::string& name) const;
  int whole(const std::string& name) const { return static_cast<int>(number(name)); }
  std::vector<double> numbers(const std::string& name) const;
  std::optional<std::pair<double, double>> from_to(const std::string& name) const;
  void set(const std::string& flag) { given_[flag]; }  ///< as if it were on the command line

  const Command& command() const { return *command_; }
  Receiver* receiver() const { return receiver_; }  ///< null: a terminal, a file or a pipe
  /// What repeats the command: "beamid modes --modes 5". Where its results went is no part of it.
  const std::string& command_line() const { return line_; }

 private:
  const Option& option(const std::string& name) const;
  void check(const Option& option) const;

  const Command* command_;
  Receiver* receiver_;
  std::map<std::string, Words> given_;
  std::string line_;
};

// The terminal that text goes to, if it is one.

/// Where standard output is a terminal its width, COLUMNS of the environment before what it says itself, and
/// colours unless NO_COLOR is set or TERM is "dumb"; elsewhere 100 columns without colours.
experiments::Page terminal_page();

/// What is being done, on one line of standard error that is written over, where that is a terminal and
/// neither --quiet nor --no-progress is given; with --verbose a line each with the time since the start,
/// terminal or not; where a program receives what is found, that program is told. Safe to call from any
/// thread.
experiments::Progress show_progress(const Values& values);

/// Wipes that line.
void clear_progress();

}  // namespace beamid::apps
