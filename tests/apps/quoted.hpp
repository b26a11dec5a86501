// What docs/study.md quotes of the commands' results.
#pragma once

#include "tests/apps/run_command.hpp"

namespace beamid::apps {

void expect_quoted(const std::string& words);

/// What the command prints with --json; run once.
const nlohmann::json& found_by(const std::string& command);

/// "+6.41411": as the document writes it.
std::string written(double value, const char* format);

/// "| +6.242 | 1e-7 |" of numbers, each as the document writes it.
std::string row_of(const nlohmann::json& numbers, const char* format);

/// A key of every entry of a list.
nlohmann::json column_of(const nlohmann::json& list, const nlohmann::json::json_pointer& key,
                         double scale = 1.0);

}  // namespace beamid::apps
