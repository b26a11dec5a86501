// A whole text file in memory.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace beamid::experiments {

/// The file, ready to be read as it is.
///
/// @param expected what the file should hold, for messages: "a TOML file".
/// @throws InputError when it is missing, a directory or may not be read.
std::ifstream open_input(const std::filesystem::path& file, const std::string& expected);

/// All its bytes. @throws InputError likewise, and when there are none.
std::string read_bytes(const std::filesystem::path& file, const std::string& expected);

/// How many bytes it has, without reading them: for libraries that read it themselves. @throws likewise.
std::size_t count_bytes(const std::filesystem::path& file, const std::string& expected);

/// The file's bytes, without the byte-order mark some editors put in front.
///
/// @param expected what the file should hold, for messages: "a TOML file".
/// @throws InputError when the file is missing, a directory, unreadable, empty or not text (holds a control
/// byte
///         that no text has, as compressed, binary and UTF-16 files do).
std::string read_text(const std::filesystem::path& file, const std::string& expected);

}  // namespace beamid::experiments
