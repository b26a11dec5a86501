// docs/architecture.md shows the rooms of experiments/ as they are. Oracle: the sources' own includes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/layers/include_rules.hpp"
#include "tests/layers/source_files.hpp"

namespace beamid::layers::rooms_test {
namespace {

struct Room {
  int files = 0, lines = 0;
  std::set<std::string> below;  ///< rooms that it includes
};

std::map<std::string, Room> rooms() {
  std::map<std::string, Room> found;
  for (const std::string& file : sources_below("experiments")) {
    const std::string text = text_of(file);
    Room& room = found[room_of(file)];
    ++room.files;
    room.lines += static_cast<int>(std::count(text.begin(), text.end(), '\n'));
    for (const Include& include : includes_of(text))
      if (const std::string to = room_of(include.target); !to.empty() && to != room_of(file))
        room.below.insert(to);
  }
  return found;
}

/// The picture: a row per room, the ground at the bottom. Lines are rounded to hundreds, so that the page
/// does not change with every edit.
std::string picture(std::map<std::string, Room> found) {
  std::ostringstream text;
  text << "| room | hundreds of lines | stands on |\n|---|---|---|\n";
  for (auto floor = floors().rbegin(); floor != floors().rend(); ++floor) {
    const Room& room = found[*floor];
    text << "| `" << *floor << "` | " << (room.lines + 50) / 100 << " | ";
    bool first = true;
    for (auto below = floors().rbegin(); below != floors().rend(); ++below)
      if (room.below.contains(*below)) text << (std::exchange(first, false) ? "" : ", ") << *below;
    text << " |\n";
  }
  return text.str();
}

/// What stands between two marks of a page.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from), end = text.find(to);
  if (begin == std::string::npos || end == std::string::npos) return "";
  return text.substr(begin + from.size() + 1, end - begin - from.size() - 1);
}

// Hundreds of lines change with every edit: a tenth, or two hundred, are let pass.
TEST(Rooms, AreDrawnInTheDocumentation) {
  const std::string expected = picture(rooms()), drawn = between(text_of("docs/architecture.md"),
                                                                 "<!-- rooms -->", "<!-- end of rooms -->");
  const std::regex count(R"(\| (\d+) \|)");
  EXPECT_EQ(std::regex_replace(drawn, count, "| |"), std::regex_replace(expected, count, "| |"))
      << "docs/architecture.md should show:\n"
      << expected;
  for (std::sregex_iterator one(drawn.begin(), drawn.end(), count),
       other(expected.begin(), expected.end(), count), end;
       one != end && other != end; ++one, ++other) {
    const double now = std::stod((*other)[1]);
    EXPECT_NEAR(std::stod((*one)[1]), now, std::max(2.0, 0.1 * now)) << "docs/architecture.md should show:\n"
                                                                     << expected;
  }
}

TEST(Rooms, HaveNoLooseFiles) {
  std::vector<std::string> names;
  for (const auto& [name, room] : rooms()) names.push_back(name);
  EXPECT_THAT(names, testing::UnorderedElementsAreArray(floors()));
}

}  // namespace
}  // namespace beamid::layers::rooms_test
