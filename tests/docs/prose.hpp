// The prose of a page: its text without code, outputs, formulas, quotations and addresses, in paragraphs.
#pragma once

#include "tests/docs/compare_numbers.hpp"
#include "tests/docs/shell.hpp"

namespace beamid::docs {

struct Paragraph {
  int line;  ///< of the page, from 1, where it begins
  std::string text;
};

/// README, CONTRIBUTING and all pages of docs/.
inline std::vector<fs::path> markdown_pages() {
  std::vector<fs::path> pages{source("README.md"), source("CONTRIBUTING.md")};
  for (const auto& entry : fs::recursive_directory_iterator(source("docs")))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  std::sort(pages.begin() + 2, pages.end());
  return pages;
}

/// A text without what stands between two marks of one kind; a mark without its partner stays.
inline std::string without_between(const std::string& text, const std::string& mark) {
  std::string kept;
  for (std::size_t from = 0;;) {
    const std::size_t open = text.find(mark, from),
                      close = open == std::string::npos ? open : text.find(mark, open + mark.size());
    kept += text.substr(from, close == std::string::npos ? close : open - from);
    if (close == std::string::npos) return kept;
    kept += mark + mark;
    from = close + mark.size();
  }
}

inline std::string without_code(const std::string& text) {
  static const std::regex address(R"(\]\([^)]*\)|<[^>]*>|https?://\S+|\[[a-z]+[0-9]{4}[^\]]*\])");
  std::string prose = text;
  for (const char* mark : {"``", "`", "$$", "$", "\""}) prose = without_between(prose, mark);
  return std::regex_replace(prose, address, "]");
}

/// Rows of tables that the program writes (docs/configuration.md) begin with a key and are no prose of the
/// page.
inline std::vector<Paragraph> prose(const std::vector<std::string>& lines, bool tables_of_keys = false) {
  std::vector<Paragraph> found;
  bool fenced = false, apart = true, code = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const bool fence = line.rfind("```", 0) == 0, comment = line.rfind("<!--", 0) == 0;
    if (fence) fenced = !fenced;
    code = line.rfind("    ", 0) == 0 && (code || apart);
    const bool key = tables_of_keys && line.rfind("| `", 0) == 0;
    if (fenced || fence || code || comment || key || line.empty() || line[0] == '>') {
      apart = true;
      continue;
    }
    if (apart || line[0] == '|' || line[0] == '#') found.push_back({int(i) + 1, ""});
    found.back().text += line + "\n";
    apart = line[0] == '#';
  }
  for (Paragraph& one : found) one.text = without_code(one.text);
  return found;
}

}  // namespace beamid::docs
