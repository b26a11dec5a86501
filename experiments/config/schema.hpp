// A key of an experiment file, stated once. From its row follow the reader, the check of what a file holds,
// the suggestion for a misspelt key, the echo of the configuration, the tables of docs/configuration.md,
// `beamid list keys`, what a sweep may vary, and which keys an option of the command line replaces.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// Numbers that a key may have: from `least` to `most`, themselves included unless `above` or `below`.
struct Range {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool above = false, below = false;
  bool on_beam = false;                ///< `most` is the beam's length, which the reader supplies
  const char* greater_than = nullptr;  ///< a key of the same table: above its value, where that is given

  bool contains(double value) const;
};

inline constexpr Range any_number{};
inline constexpr Range positive{.least = 0.0, .above = true};
inline constexpr Range not_negative{.least = 0.0};
inline constexpr Range on_beam{.least = 0.0, .on_beam = true};

/// What a file says of a key; empty where it says nothing.
using KeyValue = std::variant<std::monostate, double, int, bool, std::string, std::vector<double>,
                              std::vector<std::string>, std::pair<double, double>>;

/// One row: a key and all that is known of it.
struct Key {
  enum class Type { number, whole, truth, text, texts, numbers, interval, column, table, tables };

  std::string name;
  Type type = Type::number;
  Range range = {};
  std::vector<std::string> allowed = {};   ///< texts, of which it is one; empty: any
  std::string meaning = {}, example = {};  ///< in Markdown; the example as a file has it
  std::string fallback = {};               ///< what holds without it, in Markdown
  KeyValue preset = {};                    ///< the same as a value, where it is one whatever else is given
  bool required = false;
  std::string values = {};   ///< in Markdown: what it may be, where type and range do not say all
  std::string missing = {};  ///< what is expected of a file without it, where that says more
  std::vector<std::string> with =
      {};  ///< values of the section's selector with which it has a use; empty: all
  std::vector<std::string> needed_with = {};  ///< those with which it must be given
  std::vector<std::string> excludes = {};     ///< keys that have no use beside it
  std::string instead = "one or the other";   ///< what is expected then
  std::vector<std::string> replaces =
      {};  ///< keys that give way where a command line or a sweep sets this one

  bool is_table() const { return type == Type::table || type == Type::tables; }
  /// "a number from 0 to below 1"
  std::string expected(double length = std::numeric_limits<double>::infinity()) const;
};

/// SI unit that ends the name of a key: "N m/rad" of "rotational_n_m_per_rad"; empty where there is none.
std::string unit_in_key(const std::string& key);

/// The keys of one table. Tables nest by name: "record.time" is the table `time` in [record].
class KeyTable {
 public:
  explicit KeyTable(std::string name) : name_(std::move(name)) {}

  const std::string& name() const { return name_; }  ///< empty: the file itself
  const std::vector<Key>& keys() const { return keys_; }
  const std::string& selector() const { return selector_; }  ///< key whose value others depend on, or empty
  std::vector<std::string> names() const;
  const Key* find(const std::string& key) const;  ///< null where there is none
  /// Any other key is an option of the method chosen, which checks it.
  bool has_options() const { return has_options_; }

  /// Looks at the type, the texts allowed and the range of every value, whatever else the table lacks.
  /// @throws InputError at the first one that cannot be
  void check(const TomlTable& table) const;

  /// Keys of which only one can be given with `key`, and those that it replaces: what has to go from a file
  /// in which `key` is set from outside.
  std::vector<std::string> rivals(const std::string& key) const;

  /// @throws InputError at a key that has no use with this value of the selector, or where one is missing.
  void check_use(const TomlTable& table, const std::string& selected) const;

 protected:
  /// How a member of one type is set and read.
  struct Codec {
    Key::Type type;
    void (*set)(void* member, const KeyValue& value);
    KeyValue (*get)(const void* member);
  };
  /// Defined in schema.cpp for the types of members that a key can have.
  template <class Member>
  static const Codec& codec_of();

  /// Values of an enumeration by their names; get gives -1 for an optional without value.
  struct Choices {
    std::vector<std::pair<const char*, int>> names = {};
    void (*set)(void* member, int value) = nullptr;
    int (*get)(const void* member) = nullptr;
  };
  /// Where in an object the member of a key lies; neither codec nor choices where a reader of its own takes
  /// it.
  struct Binding {
    std::ptrdiff_t offset = 0;
    const Codec* codec = nullptr;
    Choices choices = {};

    bool bound() const { return codec != nullptr || choices.set != nullptr; }
    void set(void* object, const KeyValue& value) const;
    KeyValue get(const void* object) const;
  };
  struct ExactlyOne {
    std::string what;
    std::vector<std::string> keys;
  };
  using Names = std::initializer_list<const char*>;

  std::string name_, selector_;
  std::vector<Key> keys_;
  std::vector<Binding> bindings_;  ///< of the key at the same index
  std::vector<ExactlyOne> exactly_one_;
  std::vector<std::string> at_least_one_;
  bool has_options_ = false;

  void add(const char* name, const Range& range, const char* meaning, const char* example, const void* object,
           const void* member, const Codec& codec);
  void add(const char* name, const char* meaning, const char* example, const void* object, const void* member,
           Choices choices);
  void add(const char* name, Key::Type type, const char* meaning, const char* example, const Range& range);
  void take_preset(const void* object);
  void add_rows(const KeyTable& table);
  void add_exactly_one(const char* what, Names keys);
  static void assign(std::vector<std::string>& texts, Names names);
  Key& last() { return keys_.back(); }

  void read_into(const TomlTable& table, void* object, double length) const;
};

template <class Member>
struct HeldValue {
  using Type = Member;
};
template <class Value>
struct HeldValue<std::optional<Value>> {
  using Type = Value;
};

/// The value as a default stands in the documents: `0.2`.
std::string default_text(const KeyValue& value);

/// The keys of one table and the members of T that hold their values. A member is a pointer to one, or a
/// function that gives a reference to it; double, whole numbers, bool, std::string, their std::optional,
/// vectors of numbers or texts and a pair of numbers can be held. Without .fallback() the default is the
/// member's own.
///
///     Schema<fem::Spring>("beam.springs")
///         .key("position_m", &fem::Spring::position, on_beam, "where", "1.1").required()
///         .key("translational_n_per_m", &fem::Spring::translational, not_negative, "k of a force k w",
///         "500")
template <class T>
class Schema : public KeyTable {
 public:
  using KeyTable::KeyTable;

  template <class Member>
  Schema& key(const char* name, Member member, const Range& range, const char* meaning, const char* example) {
    auto& held = std::invoke(member, fresh_);
    add(name, range, meaning, example, &fresh_, &held, codec_of<std::remove_reference_t<decltype(held)>>());
    return *this;
  }

  template <class Member>
  Schema& key(const char* name, Member member, const char* meaning, const char* example) {
    return key(name, member, any_number, meaning, example);
  }

  /// A member of an enumeration, by the names of its values.
  template <class Member, class Enumeration>
  Schema& choice(const char* name, Member member,
                 std::initializer_list<std::pair<const char*, Enumeration>> named, const char* meaning,
                 const char* example) {
    auto& held = std::invoke(member, fresh_);
    using Held = std::remove_reference_t<decltype(held)>;
    constexpr bool optional = !std::is_same_v<Held, Enumeration>;
    Choices choices;
    for (const auto& [text, value] : named) choices.names.emplace_back(text, static_cast<int>(value));
    choices.set = [](void* one, int value) { *static_cast<Held*>(one) = static_cast<Enumeration>(value); };
    choices.get = [](const void* one) {
      const Held& found = *static_cast<const Held*>(one);
      if constexpr (optional)
        return found ? static_cast<int>(*found) : -1;
      else
        return static_cast<int>(found);
    };
    add(name, meaning, example, &fresh_, &held, std::move(choices));
    return *this;
  }

  /// A key that a reader of its own takes, or a table.
  Schema& other(const char* name, Key::Type type, const char* meaning = "", const char* example = "",
                const Range& range = {}) {
    return add(name, type, meaning, example, range), *this;
  }
  Schema& tables(Names names, Key::Type type = Key::Type::tables) {
    for (const char* name : names) other(name, type);
    return *this;
  }
  /// All rows of another section, whose own reader takes them: the keys of a segment in a beam of one
  /// segment.
  Schema& like(const KeyTable& section) { return add_rows(section), *this; }

  // What follows concerns the key before it.
  Schema& required(const char* missing = "") {
    last().required = true;
    last().missing = missing;
    return fallback("-");
  }
  Schema& fallback(const char* markdown) {
    last().preset = {};
    return last().fallback = markdown, *this;
  }
  Schema& values(const char* markdown) { return last().values = markdown, *this; }
  Schema& one_of(Names texts) { return assign(last().allowed, texts), *this; }
  Schema& one_of(const std::vector<std::string>& texts) { return last().allowed = texts, *this; }
  Schema& with(Names selected) { return assign(last().with, selected), *this; }
  Schema& needed_with(Names selected) {
    assign(last().needed_with, selected);
    return with(selected);
  }
  Schema& excludes(Names keys, const char* expected = "one or the other") {
    last().instead = expected;
    return assign(last().excludes, keys), *this;
  }
  Schema& replaces(Names keys) { return assign(last().replaces, keys), *this; }

  // What follows concerns the table.
  Schema& selected_by(const char* key) { return selector_ = key, *this; }
  Schema& exactly_one(const char* what, Names keys) { return add_exactly_one(what, keys), *this; }
  Schema& at_least_one(Names keys) { return assign(at_least_one_, keys), *this; }
  Schema& with_options() { return has_options_ = true, *this; }

  /// @param length of the beam, to which positions must belong [m]
  /// @throws InputError at a value that cannot be, at the table where one is missing, at a key without use.
  T read(const TomlTable& table, double length = std::numeric_limits<double>::infinity()) const {
    T object{};
    read_into(table, &object, length);
    return object;
  }
  /// The same into an object whose other members stay, and those whose keys are absent.
  void read_onto(const TomlTable& table, T& object) const {
    read_into(table, &object, std::numeric_limits<double>::infinity());
  }

 private:
  T fresh_{};  ///< its members are the defaults, and show where those of another object lie
};

}  // namespace beamid::experiments
