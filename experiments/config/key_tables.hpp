// The tables of an experiment file, and what a file as a whole may hold.
#pragma once

#include <string>
#include <vector>

#include "experiments/config/schema.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
