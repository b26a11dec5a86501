#include "experiments/config/schema.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "experiments/config/useless_keys.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

// The value of one key in a user's table.

using Type = Key::Type;

bool same_limits(const Range& a, const Range& b) {
  return a.least == b.least && a.most == b.most && a.above == b.above && a.below == b.below &&
         a.on_beam == b.on_beam;
}

KeyValue number_value(const TomlTable& table, const Key& key, double length) {
  const bool no_beam = key.range.on_beam && std::isinf(length);
  const Sign sign = no_beam || same_limits(key.range, not_negative) ? Sign::not_negative
                    : same_limits(key.range, positive)              ? Sign::positive
                                                                    : Sign::any;
  const auto value = table.find_number(key.name, sign);
  if (!value) return {};
  if (key.range.on_beam && std::isnan(length)) return *value;
  Range range = key.range;
  constexpr double rounding = 1e-12;  // heights that add up to 0.9 make 0.8999999999999999
  if (range.on_beam) range.most = length;
  if (range.on_beam && *value > length && *value <= length * (1.0 + rounding)) return length;
  if (!range.contains(*value)) table.refuse(key.name, key.expected(length));
  return *value;
}

KeyValue column_value(const TomlTable& table, const Key& key) {
  const auto value = table.find_value(key.name);
  if (!value) return {};
  if (std::holds_alternative<double>(*value))
    return *table.find_whole_number(key.name, static_cast<int>(key.range.least),
                                    static_cast<int>(key.range.most));
  const std::string* const text = std::get_if<std::string>(&*value);
  if (text == nullptr || text->empty()) table.refuse(key.name, key.expected());
  return *text;
}

KeyValue text_value(const TomlTable& table, const Key& key) {
  const auto text = key.allowed.empty() ? table.find_text(key.name) : table.find_text(key.name, key.allowed);
  return text ? KeyValue(*text) : KeyValue();
}

template <class Found>
KeyValue value_or_nothing(const std::optional<Found>& found) {
  return found ? KeyValue(*found) : KeyValue();
}

/// @param length of the beam; infinite where none is described, NaN where it is not known yet
/// @returns nothing where the table does not hold the key, or where it holds tables
/// @throws InputError at the value's place where it is not what Key::expected() says
KeyValue read_value(const TomlTable& table, const Key& key, double length) {
  switch (key.type) {
    case Type::number:
      return number_value(table, key, length);
    case Type::whole:
      return value_or_nothing(table.find_whole_number(key.name, static_cast<int>(key.range.least),
                                                      static_cast<int>(key.range.most)));
    case Type::truth:
      return value_or_nothing(table.find_truth(key.name));
    case Type::text:
      return text_value(table, key);
    case Type::texts:
      return value_or_nothing(table.find_texts(key.name));
    case Type::numbers:
      return value_or_nothing(table.find_numbers(
          key.name, same_limits(key.range, not_negative) ? Sign::not_negative : Sign::any));
    case Type::interval:
      return value_or_nothing(table.find_interval(key.name));
    case Type::column:
      return column_value(table, key);
    case Type::table:
      table.find_table(key.name);
      break;
    case Type::tables:
      table.find_tables(key.name);
      break;
  }
  return {};
}

using Type = Key::Type;
constexpr double length_not_known = std::numeric_limits<double>::quiet_NaN();

bool contains_text(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

template <class Stored>
constexpr Type type_of = std::is_same_v<Stored, double>                     ? Type::number
                         : std::is_same_v<Stored, int>                      ? Type::whole
                         : std::is_same_v<Stored, bool>                     ? Type::truth
                         : std::is_same_v<Stored, std::string>              ? Type::text
                         : std::is_same_v<Stored, std::vector<std::string>> ? Type::texts
                         : std::is_same_v<Stored, std::vector<double>>      ? Type::numbers
                                                                            : Type::interval;

void check_order(const TomlTable& table, const Key& key) {
  if (key.range.greater_than == nullptr || !table.contains(key.name)) return;
  const auto other = table.find_number(key.range.greater_than);
  if (other && *other >= *table.find_number(key.name))
    table.refuse(key.name, fmt::format("a number above {}, {}", key.range.greater_than, *other));
}

}  // namespace

bool Range::contains(double value) const {
  return (above ? value > least : value >= least) && (below ? value < most : value <= most);
}

std::string Key::expected(double length) const {
  const double limit = range.on_beam ? length : range.most;
  switch (type) {
    case Type::number:
      if (range.on_beam && std::isfinite(length))
        return fmt::format("a number from 0 to the beam's length, {}", length);
      if (!std::isfinite(range.least)) return "a number";
      if (!std::isfinite(limit)) return range.above ? "a positive number" : "zero or a positive number";
      if (range.above) return fmt::format("a number above {:g}, at most {:g}", range.least, limit);
      return fmt::format("a number from {:g} to {}{:g}", range.least, range.below ? "below " : "", limit);
    case Type::whole:
      return fmt::format("a whole number from {} to {}", static_cast<int>(range.least),
                         static_cast<int>(range.most));
    case Type::truth:
      return "true or false";
    case Type::text:
      return allowed.empty() ? "a text in quotes" : "one of " + joined(allowed);
    case Type::texts:
      return "an array of at least one text";
    case Type::numbers:
      return "an array of at least one number";
    case Type::interval:
      return "two numbers [from, to], the first below the second";
    case Type::column:
      return "a column's number, from 1, or its name in the header";
    case Type::table:
      return "a table";
    case Type::tables:
      break;
  }
  return "an array of at least one table";
}

std::vector<std::string> KeyTable::names() const {
  std::vector<std::string> names;
  for (const Key& key : keys_) names.push_back(key.name);
  return names;
}

const Key* KeyTable::find(const std::string& name) const {
  const auto found =
      std::find_if(keys_.begin(), keys_.end(), [&](const Key& key) { return key.name == name; });
  return found == keys_.end() ? nullptr : &*found;
}

template <class Member>
const KeyTable::Codec& KeyTable::codec_of() {
  using Value = typename HeldValue<Member>::Type;
  constexpr bool optional = !std::is_same_v<Member, Value>;
  constexpr bool whole = std::is_integral_v<Value> && !std::is_same_v<Value, bool>;
  using Stored = std::conditional_t<whole, int, Value>;
  static const Codec codec{type_of<Stored>,
                           [](void* member, const KeyValue& value) {
                             *static_cast<Member*>(member) = static_cast<Value>(std::get<Stored>(value));
                           },
                           [](const void* member) -> KeyValue {
                             const Member& held = *static_cast<const Member*>(member);
                             if constexpr (optional)
                               return held ? KeyValue(static_cast<Stored>(*held)) : KeyValue();
                             else
                               return static_cast<Stored>(held);
                           }};
  return codec;
}

template const KeyTable::Codec& KeyTable::codec_of<double>();
template const KeyTable::Codec& KeyTable::codec_of<std::optional<double>>();
template const KeyTable::Codec& KeyTable::codec_of<int>();
template const KeyTable::Codec& KeyTable::codec_of<std::optional<int>>();
template const KeyTable::Codec& KeyTable::codec_of<std::uint64_t>();
template const KeyTable::Codec& KeyTable::codec_of<std::ptrdiff_t>();
template const KeyTable::Codec& KeyTable::codec_of<bool>();
template const KeyTable::Codec& KeyTable::codec_of<std::optional<bool>>();
template const KeyTable::Codec& KeyTable::codec_of<std::string>();
template const KeyTable::Codec& KeyTable::codec_of<std::optional<std::string>>();
template const KeyTable::Codec& KeyTable::codec_of<std::vector<double>>();
template const KeyTable::Codec& KeyTable::codec_of<std::optional<std::vector<double>>>();
template const KeyTable::Codec& KeyTable::codec_of<std::vector<std::string>>();
template const KeyTable::Codec& KeyTable::codec_of<std::pair<double, double>>();
template const KeyTable::Codec& KeyTable::codec_of<std::optional<std::pair<double, double>>>();

void KeyTable::Binding::set(void* object, const KeyValue& value) const {
  void* const member = static_cast<char*>(object) + offset;
  if (codec != nullptr) return codec->set(member, value);
  for (const auto& [name, meant] : choices.names)
    if (std::get<std::string>(value) == name) choices.set(member, meant);
}

KeyValue KeyTable::Binding::get(const void* object) const {
  const void* const member = static_cast<const char*>(object) + offset;
  if (codec != nullptr) return codec->get(member);
  for (const auto& [name, meant] : choices.names)
    if (choices.get(member) == meant) return std::string(name);
  return {};
}

void KeyTable::add(const char* name, Type type, const char* meaning, const char* example,
                   const Range& range) {
  keys_.push_back({.name = name, .type = type, .range = range, .meaning = meaning, .example = example});
  last().fallback = "none";
  bindings_.emplace_back();
}

void KeyTable::add(const char* name, const Range& range, const char* meaning, const char* example,
                   const void* object, const void* member, const Codec& codec) {
  add(name, codec.type, meaning, example, range);
  bindings_.back() = {static_cast<const char*>(member) - static_cast<const char*>(object), &codec, {}};
  take_preset(object);
}

void KeyTable::add(const char* name, const char* meaning, const char* example, const void* object,
                   const void* member, Choices choices) {
  add(name, Type::text, meaning, example, any_number);
  for (const auto& choice : choices.names) last().allowed.emplace_back(choice.first);
  bindings_.back() = {static_cast<const char*>(member) - static_cast<const char*>(object), nullptr,
                      std::move(choices)};
  take_preset(object);
}

void KeyTable::take_preset(const void* object) {
  last().preset = bindings_.back().get(object);
  last().fallback = default_text(last().preset);
}

void KeyTable::add_exactly_one(const char* what, Names keys) {
  exactly_one_.push_back({what, {keys.begin(), keys.end()}});
}

void KeyTable::assign(std::vector<std::string>& texts, Names names) {
  texts.assign(names.begin(), names.end());
}

void KeyTable::add_rows(const KeyTable& section) {
  for (Key key : section.keys_) {
    key.preset = {};  // another table may hold the key
    keys_.push_back(std::move(key));
  }
  bindings_.resize(keys_.size());
  exactly_one_.insert(exactly_one_.end(), section.exactly_one_.begin(), section.exactly_one_.end());
}

void KeyTable::check(const TomlTable& table) const {
  for (const std::string& name : table.keys())
    if (const Key* const key = find(name)) read_value(table, *key, length_not_known);
}

void KeyTable::check_use(const TomlTable& table, const std::string& selected) const {
  std::vector<std::string> useful;
  for (const Key& key : keys_)
    if (key.with.empty() || contains_text(key.with, selected)) useful.push_back(key.name);
  refuse_all_but(table, useful, fmt::format("with {} = \"{}\"", selector_, selected));
  for (const Key& key : keys_)
    if (contains_text(key.needed_with, selected) && !table.contains(key.name))
      table.miss(key.name, key.missing.empty() ? key.expected() : key.missing);
}

std::vector<std::string> KeyTable::rivals(const std::string& name) const {
  std::vector<std::string> rivals;
  const auto add = [&](const std::string& rival) {
    if (rival != name && !contains_text(rivals, rival)) rivals.push_back(rival);
  };
  for (const Key& key : keys_) {
    if (key.name == name) {
      for (const std::string& rival : key.excludes) add(rival);
      for (const std::string& rival : key.replaces) add(rival);
    }
    if (contains_text(key.excludes, name)) add(key.name);
  }
  for (const ExactlyOne& group : exactly_one_)
    if (contains_text(group.keys, name))
      for (const std::string& rival : group.keys) add(rival);
  return rivals;
}

void KeyTable::read_into(const TomlTable& table, void* object, double length) const {
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (!bindings_[i].bound()) continue;
    const KeyValue value = read_value(table, keys_[i], length);
    if (!std::holds_alternative<std::monostate>(value)) bindings_[i].set(object, value);
  }
  for (std::size_t i = 0; i < keys_.size(); ++i)
    if (keys_[i].name == selector_ && bindings_[i].bound())
      if (const KeyValue value = bindings_[i].get(object); !std::holds_alternative<std::monostate>(value))
        check_use(table, std::get<std::string>(value));
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const Key& key = keys_[i];
    if (!bindings_[i].bound()) continue;
    if (key.required && !table.contains(key.name))
      table.miss(key.name, key.missing.empty() ? key.expected(length) : key.missing);
    check_order(table, key);
  }
  for (const ExactlyOne& group : exactly_one_) {
    if (!bindings_[static_cast<std::size_t>(find(group.keys.front()) - keys_.data())].bound()) continue;
    const std::vector<std::string> given = given_keys(table, group.keys);
    if (given.size() != 1)
      throw InputError(table.place(),
                       fmt::format("{} is given by {}; expected exactly one of {}", group.what,
                                   given.empty() ? "no key" : joined(given), joined(group.keys)));
  }
  if (!at_least_one_.empty() && given_keys(table, at_least_one_).empty())
    throw InputError(table.place(), fmt::format("{} has no effect; expected at least one of {}", table.name(),
                                                joined(at_least_one_)));
  for (std::size_t i = 0; i < keys_.size(); ++i)
    if (bindings_[i].bound() && table.contains(keys_[i].name))
      refuse_useless(table, keys_[i].excludes, "beside " + keys_[i].name, keys_[i].instead);
}

}  // namespace beamid::experiments
