// A TOML file's tables, read key by key with checks that name file, line and column.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/text/input_error.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

// A whole text file in memory.

// JSON that a beamid command wrote, read back.

/// @param expected what the file should hold, for messages: "the results of a beamid command".
/// @throws InputError when it cannot be read, is no JSON (at its place), no object, or nests more than 64
/// levels deep, which those who walk through it do not expect.
nlohmann::ordered_json read_json(const std::filesystem::path& file, const std::string& expected);

/// A value that is a whole number from least to most; nlohmann's get() would convert 1e92 to whatever it
/// likes.
/// @param key its name, for messages.
/// @throws std::invalid_argument when it is anything else.
std::int64_t whole_number(const nlohmann::json& value, const std::string& key, std::int64_t least,
                          std::int64_t most);

/// The file, ready to be read as it is.
///
/// @param expected what the file should hold, for messages: "a TOML file".
/// @throws InputError when it is missing, a directory or may not be read.
std::ifstream open_input(const std::filesystem::path& file, const std::string& expected);

/// All its bytes. @throws InputError likewise, and when there are none.
std::string read_bytes(const std::filesystem::path& file, const std::string& expected);

/// How many bytes it has, without reading them: for libraries that read it themselves. @throws likewise.
std::size_t count_bytes(const std::filesystem::path& file, const std::string& expected);

/// The file's bytes, without the byte-order mark some editors put in front.
///
/// @param expected what the file should hold, for messages: "a TOML file".
/// @throws InputError when the file is missing, a directory, unreadable, empty or not text (holds a control
/// byte
///         that no text has, as compressed, binary and UTF-16 files do).
std::string read_text(const std::filesystem::path& file, const std::string& expected);

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
