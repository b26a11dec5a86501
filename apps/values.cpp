#include "apps/values.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <mutex>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <boost/program_options.hpp>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::apps {
namespace {

namespace po = boost::program_options;
using Found = const Option*;

bool is_number(const std::string& word) {
  return experiments::number(word).has_value();
}

bool looks_like_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && !is_number(word);
}

std::vector<Found> options_of(const Command& command) {
  std::vector<Found> all;
  for (const OptionGroup& group : command.options)
    for (const Option& option : group.options) all.push_back(&option);
  for (const Option& option : common_options()) all.push_back(&option);
  return all;
}

/// "--band" or "-b" of a word "--band=2"; null where the command has no such option.
Found option_of(const Command& command, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  for (const Found option : options_of(command))
    if (name == "--" + option->name || (option->letter && name == std::string{'-', option->letter}))
      return option;
  return nullptr;
}

po::options_description description_of(const Command& command) {
  po::options_description all;
  for (const Found option : options_of(command)) {
    const std::string names = option->name + (option->letter ? std::string{',', option->letter} : "");
    if (option->values == 0)
      all.add_options()(names.c_str(), "");
    else if (option->values == Option::all && option->type == Option::Type::text)
      all.add_options()(names.c_str(), po::value<Words>()->multitoken(), "");
    else
      all.add_options()(names.c_str(), po::value<std::string>(), "");
  }
  return all;
}

[[noreturn]] void refuse_without_value(const Option& option) {
  throw UsageError("option '--" + option.name + "' needs a value: " + option.value);
}

/// What Boost.Program_options has no word for, read before it: a negative number is no option, and an option
/// of several numbers takes numbers only, so that --window 2 10 RECORD leaves the record alone.
std::vector<po::option> take_numbers(const Command& command, Words& left) {
  po::option taken;
  if (!left[0].empty() && left[0][0] == '-' && is_number(left[0])) {
    taken.value = taken.original_tokens = {left[0]};
    left.erase(left.begin());
    return {taken};
  }
  const Found option = looks_like_option(left[0]) ? option_of(command, left[0]) : nullptr;
  if (!option || option->values == 0 || option->values == 1 || option->type == Option::Type::text) return {};
  const std::size_t most =
      option->values == Option::all ? left.size() : static_cast<std::size_t>(option->values);
  taken.string_key = option->name;
  if (const std::size_t equals = left[0].find('='); equals != std::string::npos)
    taken.value.push_back(left[0].substr(equals + 1));
  std::size_t used = 1;
  for (; taken.value.size() < most && used < left.size() && is_number(left[used]); ++used)
    taken.value.push_back(left[used]);
  if (taken.value.empty()) refuse_without_value(*option);
  taken.original_tokens.assign(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(used));
  left.erase(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(used));
  return {taken};
}

[[noreturn]] void refuse_unknown(const Command& command, const std::string& word) {
  if (!word.starts_with("--")) throw UsageError("unrecognised option '" + word.substr(0, 2) + "'");
  Words known;
  for (const Option& option : command.all_options()) known.push_back("--" + option.name);
  const std::string name = word.substr(0, word.find('='));
  throw UsageError("unrecognised option '" + name + "'" + suggestion(name, known));
}

/// What stands behind --help or --version is not looked at.
Words up_to_help(const Words& words) {
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i)
    if (words[i] == "--help" || words[i] == "-h" || words[i] == "--version" || words[i] == "-V")
      return {words.begin(), words.begin() + static_cast<std::ptrdiff_t>(i) + 1};
  return words;
}

/// Options, and words that are none, in their order.
std::vector<po::option> parsed(const Command& command, const Words& words) {
  using namespace po::command_line_style;
  const po::options_description known = description_of(command);
  try {
    return po::command_line_parser(up_to_help(words))
        .options(known)
        .style(allow_long | long_allow_adjacent | long_allow_next | allow_short | allow_dash_for_short |
               short_allow_adjacent | short_allow_next | allow_sticky)
        .extra_style_parser([&](Words& left) { return take_numbers(command, left); })
        .run()
        .options;
  } catch (const po::unknown_option& error) {
    refuse_unknown(command, error.get_option_name());
  } catch (const po::invalid_command_line_syntax& error) {
    const Found option = option_of(command, error.get_option_name());
    if (!option) throw UsageError(error.what());
    if (option->values == 0) throw UsageError("option '--" + option->name + "' takes no value");
    refuse_without_value(*option);
  }
}

}  // namespace

Values::Values(const Command& command, const Words& words, Receiver* receiver)
    : command_(&command), receiver_(receiver), line_("beamid " + command.name) {
  std::size_t place = 0;
  for (const po::option& one : parsed(command, words)) {
    const Words& values = one.value;
    const Found option = one.string_key.empty() ? nullptr : option_of(command, "--" + one.string_key);
    if (option && option->values != 0 && (values.empty() || looks_like_option(values[0])))
      refuse_without_value(*option);
    if (!option) {
      if (place == command.words.size())
        throw UsageError(fmt::format("unexpected argument '{}'; expected: beamid {} {}", values[0],
                                     command.name, command.arguments));
      const Argument& argument = command.words[place];
      given_[argument.name].push_back(values[0]);
      if (!argument.several) ++place;
      line_ += " " + experiments::shell_word(values[0]);
      continue;
    }
    if (given_.contains(option->name) && option->values != 0 && !option->repeats)
      throw UsageError("option '--" + option->name + "' is given twice; expected once");
    Words& all = given_[option->name];
    all.insert(all.end(), values.begin(), values.end());
    if (option->name == "help" || option->name == "version") return;
    if (!option->recorded) continue;
    line_ += " --" + option->name;
    for (const std::string& value : values) line_ += " " + experiments::shell_word(value);
  }
  for (const OptionGroup& group : command.options)
    for (const Option& one : group.options) {
      if (has(one.name)) check(one);
      if (one.required && !has(one.name)) throw UsageError("--" + one.name + " " + one.value + " is missing");
    }
  for (const Argument& argument : command.words)
    if (argument.required && !has(argument.name))
      throw UsageError(
          fmt::format("which {}?{}", argument.shown(), argument.hint.empty() ? "" : " " + argument.hint));
}

void Values::check(const Option& option) const {
  const Words& words = given_.at(option.name);
  const auto refuse = [&](const std::string& word) {
    const std::string shown = is_number(word) ? word : "'" + word + "'";
    throw UsageError(fmt::format("--{} is {}; expected {}{}", option.name, shown, option.expected(),
                                 suggestion(word, option.closed ? option.choices : Words())));
  };
  for (const std::string& word : words) {
    if (option.closed &&
        std::find(option.choices.begin(), option.choices.end(), word) == option.choices.end())
      refuse(word);
    if (option.type != Option::Type::number && option.type != Option::Type::whole) continue;
    const std::optional<double> value = experiments::number(word);
    if (!value || (option.type == Option::Type::whole && *value != std::floor(*value))) refuse(word);
    if (*value < option.least || (option.above && *value <= option.least)) refuse(word);
    if (*value > option.most || (option.below && *value >= option.most)) refuse(word);
  }
  if (option.values != 2) return;
  if (words.size() != 2) throw UsageError("--" + option.name + " needs two numbers: FROM TO");
  if (!(*experiments::number(words[0]) < *experiments::number(words[1])))
    throw UsageError(
        fmt::format("--{0} ends at {2}, before its start at {1}; expected the smaller number first",
                    option.name, words[0], words[1]));
}

const Option& Values::option(const std::string& name) const {
  for (const OptionGroup& group : command_->options)
    for (const Option& one : group.options)
      if (one.name == name) return one;
  throw std::logic_error("command " + command_->name + " has no option " + name);
}

Words Values::texts(const std::string& name) const {
  if (const auto found = given_.find(name); found != given_.end()) return found->second;
  for (const Argument& argument : command_->words)
    if (argument.name == name) return {};
  const std::string& fallback = option(name).fallback;
  return fallback.empty() ? Words{} : Words{fallback};
}

const std::string& Values::text(const std::string& name) const {
  if (const auto found = given_.find(name); found != given_.end()) return found->second.back();
  return option(name).fallback;
}

double Values::number(const std::string& name) const {
  return experiments::number(text(name)).value();
}

std::vector<double> Values::numbers(const std::string& name) const {
  std::vector<double> values;
  for (const std::string& word : texts(name)) values.push_back(experiments::number(word).value());
  return values;
}

std::optional<std::pair<double, double>> Values::from_to(const std::string& name) const {
  if (!has(name)) return std::nullopt;
  const std::vector<double> values = numbers(name);
  return std::pair{values.at(0), values.at(1)};
}

namespace {

using experiments::Page;

constexpr const char* clear_line = "\r\033[K";

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// 0 where it is not known.
std::size_t columns_of(int terminal) {
  constexpr double narrowest = 20, widest = 1000;
  const auto stated = experiments::number(environment("COLUMNS"));
  if (stated && *stated >= narrowest && *stated <= widest) return static_cast<std::size_t>(*stated);
  winsize size{};
  if (ioctl(terminal, TIOCGWINSZ, &size) != 0 || size.ws_col < narrowest) return 0;
  return size.ws_col;
}

/// Cut to one line of the terminal: a line that breaks is not wiped as a whole.
std::string one_line(const std::string& text) {
  const std::size_t width = columns_of(STDERR_FILENO);
  if (width == 0 || experiments::width_of(text) < width) return text;
  std::string cut;
  for (std::size_t i = 0, shown = 0; i < text.size(); ++i) {
    if ((text[i] & 0xC0) != 0x80 && ++shown >= width) break;
    cut += text[i];
  }
  return cut;
}

}  // namespace

Page terminal_page() {
  Page page;
  if (!isatty(STDOUT_FILENO)) return page;
  if (const std::size_t width = columns_of(STDOUT_FILENO)) page.width = width;
  page.colour = environment("NO_COLOR").empty() && environment("TERM") != "dumb";
  return page;
}

experiments::Progress show_progress(const Values& values) {
  if (Receiver* const receiver = values.receiver())
    return [receiver](const std::string& what) { receiver->progress(what); };
  static std::mutex one_at_a_time;
  if (values.has("verbose"))
    return [started = std::chrono::steady_clock::now()](const std::string& what) {
      const std::chrono::duration<double> since = std::chrono::steady_clock::now() - started;
      const std::lock_guard lock(one_at_a_time);
      std::cerr << fmt::format("{:8.2f} s  {}\n", since.count(), experiments::clean_text(what)) << std::flush;
    };
  if (values.has("quiet") || values.has("no-progress") || !isatty(STDERR_FILENO))
    return [](const std::string&) {};
  return [](const std::string& what) {
    const std::lock_guard lock(one_at_a_time);
    std::cerr << clear_line << one_line(experiments::clean_text(what) + " ...") << std::flush;
  };
}

void clear_progress() {
  if (isatty(STDERR_FILENO)) std::cerr << clear_line << std::flush;
}

}  // namespace beamid::apps
