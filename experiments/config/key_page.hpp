// The keys as docs/configuration.md and `beamid list keys` show them.
#pragma once

#include <string>

#include "experiments/config/key_tables.hpp"

namespace beamid::experiments {

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
