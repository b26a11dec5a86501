#include "experiments/text/toml_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "experiments/text/input_error.hpp"
#include "experiments/text/memory_need.hpp"
#include "experiments/text/toml_node.hpp"

namespace beamid::experiments {

using Json = nlohmann::ordered_json;

Json read_json(const std::filesystem::path& file, const std::string& expected) {
  constexpr int deepest = 64;
  const std::string text = read_text(file, expected);
  const auto check_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > deepest)
      throw InputError({file.string()},
                       fmt::format("JSON of more than {} levels; expected {}", deepest, expected));
    return true;
  };
  try {
    Json json = Json::parse(text, check_depth);
    if (!json.is_object()) throw InputError({file.string()}, "no JSON object; expected " + expected);
    return json;
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    throw InputError(
        {file.string(), static_cast<std::size_t>(line), before == std::string::npos ? at + 1 : at - before},
        "no JSON; expected " + expected);
  } catch (const Json::exception&) {
    throw InputError({file.string()}, "a number beyond double precision; expected " + expected);
  }
}

std::int64_t whole_number(const nlohmann::json& value, const std::string& key, std::int64_t least,
                          std::int64_t most) {
  const bool fits = value.is_number_unsigned()
                        ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(most)
                        : value.is_number_integer() && value.get<std::int64_t>() <= most;
  if (!fits || value.get<std::int64_t>() < least)
    throw std::invalid_argument(fmt::format("{} is {}; expected a whole number from {} to {}", key,
                                            value.is_primitive() ? value.dump() : value.type_name(), least,
                                            most));
  return value.get<std::int64_t>();
}

namespace {

bool is_binary(char byte) {
  return byte >= 0 && byte < '\t';
}

/// Refuses what memory does not hold as bytes and, at 8 bytes each, as the numbers that they may be. Of a
/// pipe no size is known before its end.
void require_fitting(const std::filesystem::path& file, double bytes) {
  try {
    require_memory(bytes, "bytes of a file", 8.0);
  } catch (const std::invalid_argument& error) {
    throw InputError({file.string()}, error.what());
  }
}

/// UTF-16 in UTF-8: text of spreadsheets and of instruments' software. @param high whether the first byte is
/// the higher
std::string from_utf16(const std::string& bytes, bool high) {
  std::string text;
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]),
               second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<unsigned>(high ? first << 8 | second : second << 8 | first);
  };
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
    unsigned code = unit(at);
    constexpr unsigned replacement = 0xFFFD;  // of half a pair of surrogates
    if (code >= 0xD800 && code < 0xE000) {
      const unsigned second = at + 3 < bytes.size() ? unit(at + 2) : 0;
      const bool pair = code < 0xDC00 && second >= 0xDC00 && second < 0xE000;
      code = pair ? 0x10000 + ((code - 0xD800) << 10) + (second - 0xDC00) : replacement;
      if (pair) at += 2;
    }
    if (code < 0x80) {
      text += static_cast<char>(code);
      continue;
    }
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    text += static_cast<char>((more == 1 ? 0xC0 : more == 2 ? 0xE0 : 0xF0) | (code >> (6 * more) & 0x1F));
    for (int k = more - 1; k >= 0; --k) text += static_cast<char>(0x80 | (code >> (6 * k) & 0x3F));
  }
  return text;
}

/// Puts the mark in front of text in UTF-16 that has none: every other byte is zero.
void mark_utf16(std::string& text) {
  constexpr std::size_t looked_at = 64;
  const std::size_t size = std::min(text.size(), looked_at) & ~std::size_t{1};
  std::size_t zeros[2] = {0, 0};
  for (std::size_t k = 0; k < size; ++k) zeros[k % 2] += text[k] == '\0' ? 1 : 0;
  for (const std::size_t high : {0U, 1U})
    if (size > 8 && zeros[high] > size / 2 - size / 8 && zeros[1 - high] == 0)
      text.insert(0, high == 0 ? "\xFE\xFF" : "\xFF\xFE");
}

}  // namespace

std::ifstream open_input(const std::filesystem::path& file, const std::string& expected) {
  const Place place{file.string(), 0, 0};
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(file, failure);
  if (!std::filesystem::exists(status)) throw InputError(place, "no such file; expected " + expected);
  if (std::filesystem::is_directory(status)) throw InputError(place, "a directory; expected " + expected);
  if (std::filesystem::is_fifo(status))  // a file is read more than once: what it is, then what it holds
    throw InputError(place, "a pipe; expected " + expected + " in a file");
  if (std::filesystem::is_character_file(status)) throw InputError(place, "a device; expected " + expected);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(place, "cannot be opened; expected " + expected + " that may be read");
  return stream;
}

std::string read_bytes(const std::filesystem::path& file, const std::string& expected) {
  std::ifstream stream = open_input(file, expected);
  std::error_code unknown;
  const auto size = std::filesystem::file_size(file, unknown);
  if (!unknown) require_fitting(file, static_cast<double>(size));
  std::string bytes;
  if (!unknown) bytes.reserve(static_cast<std::size_t>(size) + 1);
  for (std::vector<char> part(1 << 16); stream;) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    bytes.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw InputError({file.string()}, "cannot be read to its end; expected " + expected);
  if (bytes.empty()) throw InputError({file.string()}, "an empty file; expected " + expected);
  return bytes;
}

std::size_t count_bytes(const std::filesystem::path& file, const std::string& expected) {
  std::ifstream stream = open_input(file, expected);
  stream.seekg(0, std::ios::end);
  const std::streamoff size = stream.tellg();
  if (!stream || size < 0)
    throw InputError({file.string()}, "cannot be read to its end; expected " + expected);
  if (size == 0) throw InputError({file.string()}, "an empty file; expected " + expected);
  return static_cast<std::size_t>(size);
}

std::string read_text(const std::filesystem::path& file, const std::string& expected) {
  const Place place{file.string(), 0, 0};
  std::string text = read_bytes(file, expected);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (!text.starts_with("\xFF\xFE") && !text.starts_with("\xFE\xFF")) mark_utf16(text);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    text = from_utf16(text, text.starts_with("\xFE"));
  if (text.empty()) throw InputError(place, "an empty file; expected " + expected);
  if (const auto byte = std::find_if(text.begin(), text.end(), is_binary); byte != text.end()) {
    const auto line = std::count(text.begin(), byte, '\n') + 1;
    const std::size_t before = text.rfind('\n', static_cast<std::size_t>(byte - text.begin()));
    const std::size_t start = before == std::string::npos ? 0 : before + 1;
    throw InputError({place.file, static_cast<std::size_t>(line),
                      static_cast<std::size_t>(byte - text.begin()) - start + 1},
                     "a binary byte (" + std::to_string(static_cast<int>(*byte)) + "); expected " + expected +
                         " in ASCII or UTF-8");
  }
  return text;
}

std::string found(const toml::node& node) {
  constexpr std::size_t longest = 40;
  if (const auto* text = node.as_string())
    return fmt::format("the text \"{}\"",
                       text->get().size() > longest ? text->get().substr(0, longest) + "..." : text->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  if (const auto* array = node.as_array()) return fmt::format("an array of {}", array->size());
  return node.is_table() ? "a table" : "a date or time";
}

namespace {

/// toml++ builds and destroys dotted keys recursively; one of some ten thousand parts would exhaust the
/// stack.
void refuse_long_lines(const std::string& text, const std::string& file) {
  constexpr std::size_t longest = 4096;
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > longest)
      throw InputError({file, line, longest + 1},
                       fmt::format("a line of {} characters; expected at most {}", end - begin, longest));
    begin = end + 1;
  }
}

/// The table of an override: "beam", "record.time", "sensors[2]". A table that is missing is made, one of an
/// array is not. @returns null where something else has the name: the reader will refuse it.
/// @throws InputError where the array has no such table.
toml::table* table_at(toml::table& root, const Override& over) {
  toml::table* table = &root;
  for (std::size_t begin = 0; begin <= over.table.size();) {
    const std::size_t end = std::min(over.table.find('.', begin), over.table.size());
    const std::string part = over.table.substr(begin, end - begin);
    const std::size_t bracket = part.find('[');
    const std::string name = part.substr(0, bracket);
    begin = end + 1;
    toml::node* node = table->get(name);
    if (bracket != std::string::npos) {
      toml::array* const array = node ? node->as_array() : nullptr;
      const std::string count = part.substr(bracket + 1, part.size() - bracket - 2);
      if (!part.ends_with(']') || count.empty() || count.find_first_not_of("0123456789") != std::string::npos)
        throw InputError({over.origin, 0, 0},
                         fmt::format("'{}'; expected a table by its number, as {}[1]", part, name));
      const std::size_t number = std::strtoul(count.c_str(), nullptr, 10);
      if (!array || number < 1 || number > array->size())
        throw InputError({over.origin, 0, 0}, fmt::format("there is no {}; {} has {} tables, counted from 1",
                                                          part, name, array ? array->size() : 0));
      node = array->get(number - 1);
    } else if (node == nullptr) {
      table->insert(name, toml::table());
      node = table->get(name);
    }
    table = node->as_table();
    if (table == nullptr) return nullptr;
  }
  return table;
}

/// A whole number is one to those who read it as a number, too.
void set(toml::table& table, const std::string& key, const filters::OptionValue& value) {
  constexpr double largest = 0x1p53;
  if (const double* const number = std::get_if<double>(&value);
      number && *number == std::floor(*number) && std::abs(*number) <= largest) {
    table.insert_or_assign(key, static_cast<std::int64_t>(*number));
  } else if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    toml::array array;
    for (const double one : *numbers) array.push_back(one);
    table.insert_or_assign(key, std::move(array));
  } else {
    std::visit(
        [&](const auto& plain) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(plain)>, std::vector<double>>)
            table.insert_or_assign(key, plain);
        },
        value);
  }
}

/// Sets the keys, and gives where each came from by its path.
std::map<std::string, std::string> apply(const std::vector<Override>& overrides, toml::table& root) {
  std::map<std::string, std::string> origins;
  for (const Override& over : overrides) {
    toml::table* const table = table_at(root, over);
    if (table == nullptr) continue;
    for (const std::string& key : over.instead_of) table->erase(key);
    set(*table, over.key, over.value);
    origins[over.table + "." + over.key] = over.origin;
  }
  return origins;
}

}  // namespace

TomlTable TomlTable::read(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return parse(read_text(file, "a TOML file"), file.string(), overrides);
}

TomlTable TomlTable::parse(const std::string& text, const std::string& name,
                           const std::vector<Override>& overrides) {
  refuse_long_lines(text, name);
  try {
    auto root = std::make_shared<toml::table>(toml::parse(text, name));
    auto origins = std::make_shared<const std::map<std::string, std::string>>(apply(overrides, *root));
    const toml::table* const top = root.get();
    return TomlTable(std::make_shared<const Node>(Node{std::move(root), top, name, "", std::move(origins)}));
  } catch (const toml::parse_error& error) {
    throw InputError({name, error.source().begin.line, error.source().begin.column},
                     fmt::format("no valid TOML: {}", error.description()));
  }
}

std::string TomlTable::json() const {
  std::ostringstream text;
  text << toml::json_formatter(*node_->table);
  return text.str();
}

const std::string& TomlTable::name() const {
  return node_->name;
}

std::string TomlTable::path(const std::string& key) const {
  return node_->name.empty() ? key : node_->name + "." + key;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::pair<toml::source_position, std::string>> placed;
  for (const auto& [key, value] : *node_->table)
    placed.emplace_back(key.source().begin, std::string(key.str()));
  std::stable_sort(placed.begin(), placed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (auto& [position, key] : placed) names.push_back(std::move(key));
  return names;
}

bool TomlTable::contains(const std::string& key) const {
  return node_->table->contains(key);
}

Place TomlTable::place() const {
  return node_->name.empty() ? Place{node_->file, 0, 0} : node_->at(node_->table->source());
}

Place TomlTable::key_place(const std::string& key) const {
  if (const auto origin = node_->origins->find(path(key)); origin != node_->origins->end())
    return {origin->second, 0, 0};
  const auto it = node_->table->find(key);
  return it == node_->table->end() ? place() : node_->at(it->first.source());
}

Place TomlTable::value_place(const std::string& key) const {
  if (node_->origins->contains(path(key))) return key_place(key);
  const toml::node* const value = node_->table->get(key);
  return value == nullptr ? place() : node_->at(value->source());
}

void TomlTable::refuse(const std::string& key, const std::string& expected) const {
  throw InputError(value_place(key),
                   fmt::format("{} is {}; expected {}", path(key), found(*node_->table->get(key)), expected));
}

void TomlTable::miss(const std::string& key, const std::string& expected) const {
  throw InputError(place(), fmt::format("{} is missing; expected {}", path(key), expected));
}

std::optional<TomlTable> TomlTable::find_table(const std::string& key) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) refuse(key, "a table");
  return TomlTable(node_->below(node->as_table(), path(key)));
}

std::vector<TomlTable> TomlTable::find_tables(const std::string& key) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return {};
  const toml::array* const array = node->as_array();
  if (array == nullptr || array->empty()) refuse(key, "an array of at least one table");
  std::vector<TomlTable> tables;
  for (const toml::node& element : *array) {
    const std::string name = fmt::format("{}[{}]", path(key), tables.size() + 1);
    if (!element.is_table())
      throw InputError(node_->at(element.source()),
                       fmt::format("{} is {}; expected a table", name, found(element)));
    tables.push_back(TomlTable(node_->below(element.as_table(), name)));
  }
  return tables;
}

std::vector<TomlTable> TomlTable::tables_below(const std::string& key) const {
  const toml::node* const node = node_->table->get(key);
  std::vector<TomlTable> tables;
  const auto add = [&](const toml::node& candidate, const std::string& name) {
    if (candidate.is_table()) tables.push_back(TomlTable(node_->below(candidate.as_table(), name)));
  };
  if (node == nullptr) return tables;
  add(*node, path(key));
  if (const toml::array* const array = node->as_array())
    for (const toml::node& element : *array) add(element, path(key));
  return tables;
}

TomlTable TomlTable::table(const std::string& key) const {
  const std::optional<TomlTable> value = find_table(key);
  if (!value) miss(key, "a table");
  return *value;
}

}  // namespace beamid::experiments
