// JSON that a beamid command wrote, read back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace beamid::experiments {

/// @param expected what the file should hold, for messages: "the results of a beamid command".
/// @throws InputError when it cannot be read, is no JSON (at its place), no object, or nests more than 64
/// levels deep, which those who walk through it do not expect.
nlohmann::ordered_json read_json(const std::filesystem::path& file, const std::string& expected);

/// A value that is a whole number from least to most; nlohmann's get() would convert 1e92 to whatever it
/// likes.
/// @param key its name, for messages.
/// @throws std::invalid_argument when it is anything else.
std::int64_t whole_number(const nlohmann::json& value, const std::string& key, std::int64_t least,
                          std::int64_t most);

}  // namespace beamid::experiments
