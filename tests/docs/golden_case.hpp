// tests/golden/commands.json: the commands whose output is pinned, and how closely.
#pragma once

#include "tests/docs/compare_json.hpp"
#include "tests/docs/shell.hpp"

namespace beamid::docs {

struct GoldenCase {
  std::string name;    ///< of its files tests/golden/NAME.txt and NAME.json
  std::string folder;  ///< where the command runs, in docs/tutorials
  std::string before;  ///< lines that prepare the folder
  std::string command;
  std::vector<std::string> data;  ///< measured records it needs, which lie outside the project
  bool text_only = false;         ///< it has no results.json
  std::vector<Looser> looser;

  fs::path file(const char* ending) const { return source("tests/golden") / (name + ending); }
};

inline void PrintTo(const GoldenCase& tested, std::ostream* stream) {
  *stream << tested.command;
}

inline std::vector<Looser> read_looser(const json& list) {
  std::vector<Looser> looser;
  for (const json& entry : list) {
    entry.at("reason");  // there is one, or the list is refused
    looser.push_back(
        {std::regex(entry.at("where").get<std::string>()),
         {entry.value("relative", Tolerance{}.relative), entry.value("absolute", Tolerance{}.absolute)},
         entry.value("ignored", false),
         entry.value("digits", 1.)});
  }
  return looser;
}

inline std::vector<GoldenCase> golden_cases() {
  const json file = json::parse(contents(source("tests/golden/commands.json")));
  std::vector<GoldenCase> cases;
  for (const auto& [folder, commands] : file.at("folders").items())
    for (const json& entry : commands) {
      cases.push_back({entry.at("name"), folder, entry.value("before", ""), entry.at("command"),
                       entry.value("data", std::vector<std::string>{}), entry.value("text_only", false),
                       read_looser(entry.value("looser", json::array()))});
      const std::vector<Looser> everywhere = read_looser(file.at("looser"));
      cases.back().looser.insert(cases.back().looser.end(), everywhere.begin(), everywhere.end());
    }
  return cases;
}

/// What a user sees: exit code, text, messages.
inline std::string as_text(const Outcome& outcome) {
  return "exit code " + std::to_string(outcome.code) + "\n" + outcome.out +
         (outcome.err.empty() ? "" : "--- standard error\n" + outcome.err);
}

/// Lines that differ, as "line 3: golden ..., found ...".
inline std::vector<std::string> text_differences(const std::string& golden, const std::string& found,
                                                 const std::vector<Looser>& looser) {
  const std::vector<std::string> one = lines_of(golden), other = lines_of(found);
  std::vector<std::string> differences;
  for (std::size_t i = 0; i < std::max(one.size(), other.size()); ++i) {
    const std::string first = i < one.size() ? one[i] : "(nothing)",
                      second = i < other.size() ? other[i] : "(nothing)";
    Looser allowed;
    for (const Looser& entry : looser)
      if (std::regex_search(first, entry.path)) allowed = entry;
    if (!same_line(first, second, allowed.digits, allowed.tolerance))
      differences.push_back(fmt::format("line {}: golden\n  {}\nfound\n  {}", i + 1, first, second));
  }
  return differences;
}

}  // namespace beamid::docs
