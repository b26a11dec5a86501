// A TOML file's tables, read key by key with checks that name file, line and column.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/text/input_error.hpp"
#include "filters/options.hpp"

namespace beamid::experiments {

/// What a number must satisfy beyond being finite.
enum class Sign { any, not_negative, positive };

/// One key of one table set from outside the file, such as an option of the command line. It takes the place
/// of the file's own key, and of those that would give the same quantity in another way.
struct Override {
  std::string table, key;  ///< a table within another as "record.time", one of an array as "sensors[2]"
  filters::OptionValue value;
  std::string origin;                        ///< stands for the place in messages: "--length"
  std::vector<std::string> instead_of = {};  ///< keys of the table that it removes
};

/// One table of a TOML file. `find_...` gives nothing where the key is absent, the others throw then; both
/// throw an InputError at the value's place when it has the wrong type or an impossible value.
class TomlTable {
 public:
  /// The file's root table. @throws InputError when the file cannot be read or is no valid TOML.
  static TomlTable read(const std::filesystem::path& file, const std::vector<Override>& overrides = {});

  /// The root table of a text. @param name stands for the file in messages.
  static TomlTable parse(const std::string& text, const std::string& name,
                         const std::vector<Override>& overrides = {});

  const std::string& name() const;                 ///< "record.time"; empty for the root
  std::string path(const std::string& key) const;  ///< "record.time.unit"
  std::vector<std::string> keys() const;           ///< in the order of the file
  bool contains(const std::string& key) const;
  Place place() const;                              ///< of the table's head
  Place key_place(const std::string& key) const;    ///< of the key's name
  Place value_place(const std::string& key) const;  ///< of its value; of the table where the key is absent

  std::optional<double> find_number(const std::string& key, Sign sign = Sign::any) const;
  std::optional<int> find_whole_number(const std::string& key, int least, int most) const;
  std::optional<std::string> find_text(const std::string& key) const;
  std::optional<std::string> find_text(const std::string& key, const std::vector<std::string>& allowed) const;
  std::optional<std::pair<double, double>> find_interval(
      const std::string& key) const;  ///< [from, to], from < to
  std::optional<bool> find_truth(const std::string& key) const;
  std::optional<std::vector<double>> find_numbers(const std::string& key, Sign sign) const;  ///< at least one
  std::optional<std::vector<std::string>> find_texts(const std::string& key) const;          ///< at least one
  /// Number, text, truth or numbers.
  std::optional<filters::OptionValue> find_value(const std::string& key) const;
  std::optional<TomlTable> find_table(const std::string& key) const;
  std::vector<TomlTable> find_tables(const std::string& key) const;  ///< empty only where the key is absent
  std::vector<TomlTable> tables_below(
      const std::string& key) const;  ///< the same, or one table; never throws

  /// All of it as JSON, what was set from outside included; keys in no order.
  std::string json() const;

  double number(const std::string& key, Sign sign = Sign::any) const;
  std::string text(const std::string& key) const;
  TomlTable table(const std::string& key) const;

  /// @throws InputError "beam.length_m is -1; expected a positive number" at the value's place.
  [[noreturn]] void refuse(const std::string& key, const std::string& expected) const;
  /// @throws InputError "beam.length_m is missing; expected a positive number" at the table's place.
  [[noreturn]] void miss(const std::string& key, const std::string& expected) const;

 private:
  struct Node;  ///< hides toml++, which no other file needs to see
  explicit TomlTable(std::shared_ptr<const Node> node) : node_(std::move(node)) {}

  std::shared_ptr<const Node> node_;
};

}  // namespace beamid::experiments
