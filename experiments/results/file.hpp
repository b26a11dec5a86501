// Files written so that a failure is noticed.
#pragma once

#include <filesystem>
#include <string_view>

namespace beamid::experiments {

/// Writes a whole file, replacing what was there.
/// @throws std::runtime_error naming the file and the system's reason (read-only, no space left, ...).
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace beamid::experiments
