// The keys of an experiment file, told to a reader.
#pragma once

#include <ostream>
#include <string>

#include "experiments/results/text.hpp"

namespace beamid::apps {

/// The tables of a file and how many keys each has.
void print_tables(std::ostream& stream, const experiments::Page& page);

/// Key, what it may be, unit, default and meaning of every key of a table.
/// @throws std::invalid_argument "unknown table 'beem' of an experiment file; did you mean 'beam'?"
void print_keys(std::ostream& stream, const std::string& table, const experiments::Page& page);

}  // namespace beamid::apps
