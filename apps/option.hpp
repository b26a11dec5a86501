// An option of a command, stated once: the parser, its checks, --help, the man page and completion read it.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace beamid::apps {

using Words = std::vector<std::string>;

/// Made by flag(), text(), number(), whole() or from_to(), and completed by what follows their names:
///
///     whole("modes", "K", 1, 1000, "how many, the lowest").by_default("10")
struct Option {
  enum class Type { flag, text, number, whole };
  static constexpr int all = -1;

  std::string name;   ///< without dashes: "tip-mass"
  std::string value;  ///< what its value is called, "KG"; empty of a flag
  std::string help;   ///< units in brackets
  Type type = Type::text;
  char letter = 0;            ///< of its short form
  std::string fallback = {};  ///< used where the option is not given, as it would be written; empty: none
  int values = 1;             ///< words that it takes; `all` up to the next option
  bool repeats = false;       ///< may be given again
  bool required = false;
  bool recorded = true;  ///< part of what repeats the command
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool above = false, below = false;  ///< `least` or `most` themselves are too much
  Words choices = {};                 ///< known values
  bool closed = false;                ///< no other value than these

  Option by_default(const std::string& word) const;
  Option as(char short_form) const;  ///< its short form
  Option repeated() const;
  Option needed() const;
  Option several() const;            ///< takes all words up to the next option
  Option unrecorded() const;         ///< does not change what is found
  Option from(double bound) const;   ///< at least this
  Option up_to(double bound) const;  ///< at most this
  Option greater_than(double bound) const;
  Option less_than(double bound) const;
  Option one_of(const Words& names) const;   ///< and nothing else
  Option such_as(const Words& names) const;  ///< for completion; the command checks the value

  /// "a whole number from 1 to 1000", "filter or both"
  std::string expected() const;
  /// "-o, --out DIR"
  std::string synopsis() const;
};

Option flag(const std::string& name, const std::string& help);
Option text(const std::string& name, const std::string& value, const std::string& help);
Option number(const std::string& name, const std::string& value, const std::string& help);
Option whole(const std::string& name, const std::string& value, double least, double most,
             const std::string& help);
/// Two numbers, the first below the second: --window FROM TO.
Option from_to(const std::string& name, const std::string& help);

/// "RECORD" of "record".
std::string upper_case(std::string text);

/// Names of all that is registered.
template <class Registry>
Words names_in(const Registry& registry) {
  Words names;
  for (const auto& [name, entry] : registry.entries()) names.push_back(name);
  return names;
}

/// Options under one heading of the help.
struct OptionGroup {
  std::string title;
  std::vector<Option> options;
};

/// --config, the same in every command.
Option config_option(const std::string& help = "experiment file (docs/configuration.md)");
/// --band FROM TO
Option band_option(const std::string& help);
/// --out, --force, --json, --quiet, --verbose, --no-progress: of every command that finds something.
OptionGroup output_options();
/// --help and --version, of all.
const std::vector<Option>& common_options();

}  // namespace beamid::apps
