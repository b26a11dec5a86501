// Files written so that a failure is noticed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace beamid::experiments {

/// Writes a whole file, replacing what was there.
/// @throws std::runtime_error naming the file and the system's reason (read-only, no space left, ...).
void write_file(const std::filesystem::path& file, std::string_view text);

/// The same of a file that is always whole: the new text is written beside it, to the disk itself, and takes
/// its place in one step. What killed processes have left beside it is removed. A link there is replaced, not
/// followed.
void replace_file(const std::filesystem::path& file, std::string_view text);

/// @throws std::runtime_error where replace_file() could not put anything, so that it is known before the
/// work.
void require_writable(const std::filesystem::path& file);

/// Files and folders named `prefix` and the number of a process that has ended.
std::vector<std::filesystem::path> abandoned(const std::filesystem::path& parent, const std::string& prefix);

}  // namespace beamid::experiments
