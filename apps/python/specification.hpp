// What the commands take, and what an experiment file may hold, for the Python side to make its functions of.
#pragma once

#include <string>

namespace beamid::python {

/// JSON: "version"; "commands", with the options of apps::command_groups(); "tables", with the keys of
/// experiments::key_tables(); "quantities" and "time_units", with the symbols and suffixes of their units.
std::string specification();

}  // namespace beamid::python
