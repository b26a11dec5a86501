#include "tests/apps/quoted.hpp"

#include <cstdio>
#include <map>

namespace beamid::apps {

using nlohmann::json;

void expect_quoted(const std::string& words) {
  static const std::string document = contents(source("docs/study.md"));
  EXPECT_NE(document.find(words), std::string::npos) << "docs/study.md does not say: " << words;
}

const json& found_by(const std::string& command) {
  static std::map<std::string, json> found;  // several tests quote the same command
  const auto [place, is_new] = found.try_emplace(command);
  if (is_new) place->second = json::parse(Workplace().run(command + " --json").out);
  return place->second;
}

std::string written(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string row_of(const json& numbers, const char* format) {
  std::string row = "|";
  for (const json& number : numbers)
    row += ' ' + (number.is_null() ? std::string("lost") : written(number, format)) + " |";
  return row;
}

json column_of(const json& list, const json::json_pointer& key, double scale) {
  json column = json::array();
  for (const json& one : list)
    column.push_back(one.at(key).is_null() ? json() : json(scale * one.at(key).get<double>()));
  return column;
}

}  // namespace beamid::apps
