// Pieces of a web page.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "experiments/results/table.hpp"

namespace beamid::experiments {

/// Text, cleaned (clean_text.hpp), with the characters that HTML takes for its own written as entities.
std::string escaped(std::string_view text);

/// The text that escaped() was made of.
std::string unescaped(std::string_view html);

/// [rfc4648]
std::string base64(std::string_view bytes);

/// The table with its title and note.
std::string html_table(const Table& table);

/// An SVG file as a picture inside the page, so that the page needs no other file.
/// @throws std::runtime_error when the file cannot be read.
std::string html_picture(const std::filesystem::path& svg, std::string_view description);

}  // namespace beamid::experiments
