// The messages of a source: its string literals of more than one word, adjacent ones joined.
#pragma once

#include <cctype>

#include "tests/docs/prose.hpp"

namespace beamid::docs {

/// Escapes as a reader sees them: \n begins a line, \" is a quotation mark, of \t a blank remains.
inline std::string unescaped(const std::string& literal) {
  std::string text;
  for (std::size_t i = 0; i < literal.size(); ++i)
    if (literal[i] != '\\' || i + 1 == literal.size())
      text += literal[i];
    else
      switch (literal[++i]) {
        case 'n':
          text += '\n';
          break;
        case 't':
          text += ' ';
          break;
        default:
          text += literal[i];
      }
  return text;
}

/// Line and text of each; comments, characters and lines of #include are passed over, and literals without a
/// blank: names, keys, columns, numbers.
inline std::vector<Paragraph> messages(const std::string& code) {
  std::vector<Paragraph> found;
  std::size_t i = 0, lines_to = 0;
  int line = 1;
  bool joins = false;
  const auto after = [&](const std::string& mark, std::size_t from) {
    const std::size_t end = code.find(mark, from);
    return end == std::string::npos ? code.size() : end + mark.size();
  };
  const auto end_of_quoted = [&](char mark) {  // behind the closing mark of what opens at i
    std::size_t end = i + 1;
    while (end < code.size() && code[end] != mark && code[end] != '\n') end += code[end] == '\\' ? 2 : 1;
    return std::min(end + 1, code.size());
  };
  const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  const auto take = [&](const std::string& text) {
    for (; lines_to < i; ++lines_to) line += code[lines_to] == '\n';
    if (joins)
      found.back().text += text;
    else
      found.push_back({line, text});
    joins = true;
  };
  while (i < code.size()) {
    const char c = code[i], before = i > 0 ? code[i - 1] : '\n';
    if (code.compare(i, 2, "//") == 0 ||
        (c == '#' && before == '\n' && code.compare(i, 8, "#include") == 0)) {
      i = after("\n", i);
    } else if (code.compare(i, 2, "/*") == 0) {
      i = after("*/", i);
    } else if (code.compare(i, 2, "R\"") == 0 && !in_name(before)) {
      const std::size_t open = code.find('(', i);
      const std::string close = ")" + code.substr(i + 2, open - i - 2) + "\"";
      const std::size_t end = after(close, open);
      take(code.substr(open + 1, end - close.size() - open - 1));
      i = end;
    } else if (c == '"') {
      const std::size_t end = end_of_quoted('"');
      take(unescaped(code.substr(i + 1, end - i - 2)));
      i = end;
    } else if (c == '\'' && !in_name(before)) {  // and no separator of digits
      i = end_of_quoted('\'');
      joins = false;
    } else {
      joins = joins && std::isspace(static_cast<unsigned char>(c));
      ++i;
    }
  }
  std::erase_if(found, [](const Paragraph& one) { return one.text.find(' ') == std::string::npos; });
  return found;
}

}  // namespace beamid::docs
