// JSON that a beamid command wrote, read back.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace beamid::experiments {

/// @param expected what the file should hold, for messages: "the results of a beamid command".
/// @throws InputError when it cannot be read, is no JSON (at its place), no object, or nests more than 64
/// levels deep, which those who walk through it do not expect.
nlohmann::ordered_json read_json(const std::filesystem::path& file, const std::string& expected);

}  // namespace beamid::experiments
