#include "experiments/config/key_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "experiments/config/known_names.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
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

}  // namespace beamid::experiments
