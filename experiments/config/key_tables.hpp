// The tables of an experiment file, and what a file as a whole may hold.
#pragma once

#include <string>
#include <vector>

#include "experiments/config/schema.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

// What a name might have been.

/// "did you mean 'ukf'?" where a name is near, and then "known: rts, urts" only where they are few; else
/// "known: " and all of them. To stand behind "unknown filter 'ufk'; ".
std::string known_names(const std::string& word, const std::vector<std::string>& known);

/// Makes the keys of a table known; every file that describes one does it:
///
///     const bool spring_keys_registered = register_keys([]() -> const KeyTable& { return spring_keys(); });
///
/// @param check of a table that a room above this one reads: called with it whenever an experiment is read
bool register_keys(const KeyTable& (*section)(), void (*check)(const TomlTable&) = nullptr);

/// All of them, from the file itself on, each table followed by those within it.
const std::vector<const KeyTable*>& key_tables();

/// Of the table "record.time"; null where there is none.
const KeyTable* find_key_table(const std::string& table);

/// The key of a path as "beam.length_m"; null where there is none.
const Key* find_key(const std::string& path);

/// Looks through the whole file, before anything is read: a misspelt key is the better message than "length_m
/// is missing".
/// @throws InputError at the first unknown key; where there are several, what() has a line for each.
void refuse_unknown_keys(const TomlTable& root);

/// Looks at every value of a table and of those within it: a text where a number is due is the better message
/// than what else the table lacks. @param name of the table, empty for the root
/// @throws InputError at the first value of a wrong type or out of range.
void check_values(const TomlTable& table, const std::string& name = "");

/// Tables of rooms above this one. @throws InputError as they do
void check_tables_of_others(const TomlTable& root);

// The keys as docs/configuration.md and `beamid list keys` show them.

/// "[beam]", "[[beam.springs]]" or "The file itself".
std::string heading_of(const KeyTable& section);

/// What a key may be, in Markdown: "number > 0", "`\"direct\"`, `\"modal\"`".
std::string values_text(const Key& key);

/// "| `length_m` | number > 0 | m | - | of this segment | `0.4` |"
std::string page_row(const Key& key);

/// A page with its tables of keys as the schemas have them. Below a heading that names a table, "###
/// `[beam]`", every row of a key that the table has is written anew, a row of another key is dropped, and
/// what is missing is added behind the last row; the text around stays.
std::string with_current_keys(const std::string& page);

}  // namespace beamid::experiments
