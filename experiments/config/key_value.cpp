#include "experiments/config/key_value.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

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

}  // namespace

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

}  // namespace beamid::experiments
