#include "experiments/text/json_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/text/input_error.hpp"
#include "experiments/text/text_file.hpp"

namespace beamid::experiments {

using Json = nlohmann::ordered_json;

Json read_json(const std::filesystem::path& file, const std::string& expected) {
  constexpr int deepest = 64;
  const std::string text = read_text(file, expected);
  const auto check_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > deepest)
      throw InputError({file.string()},
                       fmt::format("JSON of more than {} levels; expected {}", deepest, expected));
    return true;
  };
  try {
    Json json = Json::parse(text, check_depth);
    if (!json.is_object()) throw InputError({file.string()}, "no JSON object; expected " + expected);
    return json;
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    throw InputError(
        {file.string(), static_cast<std::size_t>(line), before == std::string::npos ? at + 1 : at - before},
        "no JSON; expected " + expected);
  } catch (const Json::exception&) {
    throw InputError({file.string()}, "a number beyond double precision; expected " + expected);
  }
}

std::int64_t whole_number(const nlohmann::json& value, const std::string& key, std::int64_t least,
                          std::int64_t most) {
  const bool fits = value.is_number_unsigned()
                        ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(most)
                        : value.is_number_integer() && value.get<std::int64_t>() <= most;
  if (!fits || value.get<std::int64_t>() < least)
    throw std::invalid_argument(fmt::format("{} is {}; expected a whole number from {} to {}", key,
                                            value.is_primitive() ? value.dump() : value.type_name(), least,
                                            most));
  return value.get<std::int64_t>();
}

}  // namespace beamid::experiments
