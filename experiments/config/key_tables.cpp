#include "experiments/config/key_tables.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "experiments/text/choice.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

std::string known_names(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t few = 6;
  const auto meant = nearest(word, known);
  std::string all = "known: " + joined(known);
  if (!meant) return all;
  return "did you mean '" + *meant + "'?" + (known.size() <= few ? " " + all : "");
}

namespace {

struct RegisteredTable {
  const KeyTable& (*section)();
  void (*check)(const TomlTable&);
};

std::vector<RegisteredTable>& registered_tables() {
  static std::vector<RegisteredTable> all;
  return all;
}

void add_with_inner(const std::string& name, std::vector<const KeyTable*>& found) {
  for (const RegisteredTable& one : registered_tables()) {
    const KeyTable& section = one.section();
    if (section.name() != name) continue;
    found.push_back(&section);
    for (const Key& key : section.keys())
      if (key.is_table()) add_with_inner(name.empty() ? key.name : name + "." + key.name, found);
  }
}

struct UnknownKey {
  Place place;
  std::string message;
};

// Of a long table only the way to its keys is worth a line.
std::string expected_keys(const std::string& key, const std::string& name, const KeyTable& section) {
  constexpr std::size_t most_listed = 40;
  const std::vector<std::string> names = section.names();
  if (names.size() <= most_listed || nearest(key, names)) return known_names(key, names);
  return fmt::format("'beamid list keys {}' shows the {} that there are", name, names.size());
}

/// @param name the table's, without the number that an element of an array has in its own name.
void collect_unknown(const TomlTable& table, const std::string& name, std::vector<UnknownKey>& unknown) {
  const KeyTable* const section = find_key_table(name);
  if (section == nullptr) return;  // the key holds a value by right, and its check will refuse the table
  for (const std::string& key : table.keys()) {
    if (section->find(key) != nullptr) {
      for (const TomlTable& below : table.tables_below(key))
        collect_unknown(below, name.empty() ? key : name + "." + key, unknown);
    } else if (!section->has_options()) {
      unknown.push_back(
          {table.key_place(key), fmt::format("unknown key '{}'{}; {}", key, name.empty() ? "" : " in " + name,
                                             expected_keys(key, name, *section))});
    }
  }
}

}  // namespace

bool register_keys(const KeyTable& (*section)(), void (*check)(const TomlTable&)) {
  registered_tables().push_back({section, check});
  return true;
}

const std::vector<const KeyTable*>& key_tables() {
  static const std::vector<const KeyTable*> all = [] {
    std::vector<const KeyTable*> found;
    add_with_inner("", found);
    return found;
  }();
  return all;
}

const KeyTable* find_key_table(const std::string& table) {
  const auto found = std::find_if(key_tables().begin(), key_tables().end(),
                                  [&](const KeyTable* section) { return section->name() == table; });
  return found == key_tables().end() ? nullptr : *found;
}

const Key* find_key(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  const KeyTable* const section = find_key_table(dot == std::string::npos ? "" : path.substr(0, dot));
  return section == nullptr ? nullptr : section->find(path.substr(dot + 1));
}

void refuse_unknown_keys(const TomlTable& root) {
  std::vector<UnknownKey> unknown;
  collect_unknown(root, "", unknown);
  if (unknown.empty()) return;
  std::stable_sort(unknown.begin(), unknown.end(),
                   [](const UnknownKey& a, const UnknownKey& b) { return a.place.line < b.place.line; });
  std::string message = unknown.front().message;
  constexpr std::size_t most = 10;
  std::set<std::string> said{message};
  for (std::size_t i = 1; i < unknown.size() && said.size() < most; ++i)
    if (said.insert(unknown[i].message).second)
      message.append("\n").append(to_string(unknown[i].place)).append(": ").append(unknown[i].message);
  if (unknown.size() > said.size())
    message += fmt::format("\n... and {} more unknown keys", unknown.size() - said.size());
  throw InputError(unknown.front().place, message);
}

void check_values(const TomlTable& table, const std::string& name) {
  const KeyTable* const section = find_key_table(name);
  if (section == nullptr) return;
  section->check(table);
  for (const Key& key : section->keys()) {
    const std::string inner = name.empty() ? key.name : name + "." + key.name;
    if (key.type == Key::Type::table) {
      if (const auto below = table.find_table(key.name)) check_values(*below, inner);
    } else if (key.type == Key::Type::tables) {
      for (const TomlTable& below : table.find_tables(key.name)) check_values(below, inner);
    }
  }
}

void check_tables_of_others(const TomlTable& root) {
  for (const RegisteredTable& one : registered_tables())
    if (one.check != nullptr)
      if (const auto table = root.find_table(one.section().name())) one.check(*table);
}

namespace {

/// The word between the first two backticks of a line; empty without.
std::string quoted_word(const std::string& line) {
  const std::size_t first = line.find('`'), last = line.find('`', first + 1);
  return last == std::string::npos ? "" : line.substr(first + 1, last - first - 1);
}

const KeyTable* table_under(const std::string& heading) {
  if (heading == "### The file itself") return find_key_table("");
  std::string table = quoted_word(heading);
  std::erase_if(table, [](char letter) { return letter == '[' || letter == ']'; });
  return table.empty() ? nullptr : find_key_table(table);
}

class PageOfKeys {
 public:
  void take(const std::string& line) {
    if (line.starts_with("#")) {
      finish();
      section_ = table_under(line);
    }
    if (section_ == nullptr || !line.starts_with("| `")) {
      lines_.push_back(line);
      if (end_of_rows_ == 0 && line.starts_with("|---")) end_of_rows_ = lines_.size();  // of none yet
      return;
    }
    const Key* const key = section_->find(quoted_word(line));
    if (key == nullptr || key->is_table() || !shown_.insert(key->name).second) return;
    lines_.push_back(page_row(*key));
    end_of_rows_ = lines_.size();
  }

  std::string text() {
    finish();
    std::string text;
    for (const std::string& line : lines_) text += (&line == &lines_.front() ? "" : "\n") + line;
    return text;
  }

 private:
  std::vector<std::string> lines_;
  const KeyTable* section_ = nullptr;
  std::set<std::string> shown_;
  std::size_t end_of_rows_ = 0;

  void finish() {
    if (section_ != nullptr && end_of_rows_ != 0)
      for (const Key& key : section_->keys())
        if (!key.is_table() && !shown_.contains(key.name))
          lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(end_of_rows_++), page_row(key));
    section_ = nullptr;
    shown_.clear();
    end_of_rows_ = 0;
  }
};

}  // namespace

std::string page_row(const Key& key) {
  return fmt::format("| `{}` | {} | {} | {} | {} | `{}` |", key.name, values_text(key), unit_in_key(key.name),
                     key.fallback, key.meaning, key.example);
}

std::string with_current_keys(const std::string& page) {
  PageOfKeys keys;
  for (const std::string& line : split(page, '\n')) keys.take(line);
  return keys.text();
}

}  // namespace beamid::experiments
