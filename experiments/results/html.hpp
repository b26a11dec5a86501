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

/// As escaped(), with the signs of typeset.hpp.
std::string typeset_html(std::string_view text);

/// The table with its title and note. A column of numbers, written or not, stands to the right with its
/// decimal points below each other.
std::string html_table(const Table& table);

/// An SVG file as a picture inside the page with its caption, so that the page needs no other file.
/// @param caption typeset as text
/// @param attributes further ones of the figure's element, as they stand: " name=\"value\""
/// @throws std::runtime_error when the file cannot be read.
std::string html_picture(const std::filesystem::path& svg, std::string_view description,
                         std::string_view caption, std::string_view attributes = {});

}  // namespace beamid::experiments
