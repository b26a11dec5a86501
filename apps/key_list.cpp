#include "apps/key_list.hpp"

#include <algorithm>
#include <stdexcept>

#include "experiments/config/key_page.hpp"
#include "experiments/config/known_names.hpp"
#include "experiments/results/print.hpp"
#include "experiments/results/table.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::apps {
namespace {

using experiments::Key;
using experiments::KeyTable;

/// Markdown marks words of a file by backticks; a terminal needs none.
std::string plain(std::string text) {
  std::erase(text, '`');
  return text;
}

std::string or_dash(const std::string& text) {
  return text.empty() ? "-" : text;
}

}  // namespace

void print_tables(std::ostream& stream, const experiments::Page& page) {
  experiments::Table table{"keys", ""};
  table.column({"table", "table"}).column({"keys", "keys"});
  for (const KeyTable* one : experiments::key_tables()) {
    std::vector<std::string> names;
    for (const Key& key : one->keys())
      if (!key.is_table()) names.push_back(key.name);
    constexpr std::size_t most = 30;  // [[parameters]] has a key for every unit
    const std::size_t more = names.size() > most ? names.size() - most : 0;
    names.resize(names.size() - more);
    table.row({experiments::heading_of(*one), experiments::joined(names) +
                                                  (more ? ", and " + std::to_string(more) + " more" : "") +
                                                  (one->has_options() ? ", options of the method" : "")});
  }
  experiments::print(stream, table, page);
}

void print_keys(std::ostream& stream, const std::string& name, const experiments::Page& page) {
  const KeyTable* const keys = experiments::find_key_table(name);
  if (keys == nullptr) {
    std::vector<std::string> known;
    for (const KeyTable* one : experiments::key_tables())
      if (!one->name().empty()) known.push_back(one->name());
    throw std::invalid_argument("unknown table '" + name + "' of an experiment file; " +
                                experiments::known_names(name, known));
  }
  experiments::Table table{"keys", ""};
  table.column({"key", "key"})
      .column({"value", "value"})
      .column({"unit", "unit"})
      .column({"default", "default"})
      .column({"meaning", "meaning"});
  for (const Key& key : keys->keys())
    if (!key.is_table())
      table.row({key.name, plain(experiments::values_text(key)), or_dash(experiments::unit_in_key(key.name)),
                 plain(key.fallback), plain(key.meaning)});
  stream << experiments::heading_of(*keys) << "\n\n";
  experiments::print(stream, table, page);
}

}  // namespace beamid::apps
