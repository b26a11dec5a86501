// A page of the documentation as its reader meets it: commands to type, and what they print.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/docs/compare_numbers.hpp"

namespace beamid::docs {

/// Commands are blocks that are indented by four spaces, outputs fences without a language. Comments that the
/// reader does not see:
///   <!-- not run: REASON -->   before a block: neither run nor compared
///   <!-- long: 105 s -->       before a command: run where BEAMID_LONG_PAGES is set
///   <!-- exit code: 3 -->      before a command: which it ends with
///   <!-- data: RECORD FOLDER -->  a measured record, which lies outside the project, put into a tutorial's
///   folder for the
///                              next command, which is left out where the record is not there
///   <!-- run: COMMAND -->      what the text asks of the reader in words
struct Block {
  enum class Kind { command, output, data } kind;
  int line;  ///< of the page, from 1, of the first of `text`
  std::vector<std::string> text;
  bool skipped = false, is_long = false;
  int exit_code = 0;
};

class Page {
 public:
  explicit Page(const std::vector<std::string>& lines) {
    for (std::size_t i = 0; i < lines.size();) {
      const std::string& line = lines[i];
      std::smatch mark;
      static const std::regex comment(R"(^<!-- ([a-z ]+): (.*) -->$)");
      if (std::regex_match(line, mark, comment)) {
        note(mark[1], mark[2], int(i) + 1);
        ++i;
      } else if (line.rfind("```", 0) == 0) {
        const std::size_t end = first_from(lines, i + 1, [](const auto& text) { return text == "```"; });
        if (line == "```") add(Block::Kind::output, lines, i + 1, end, 0);
        i = end + 1;
      } else if (line.rfind("    ", 0) == 0 &&
                 (i == 0 || lines[i - 1].empty() || lines[i - 1].rfind("<!--", 0) == 0)) {
        const std::size_t end =
            first_from(lines, i, [](const auto& text) { return text.rfind("    ", 0) != 0; });
        add(Block::Kind::command, lines, i, end, 4);
        i = end;
      } else {
        ++i;
      }
    }
  }

  const std::vector<Block>& blocks() const { return blocks_; }

 private:
  template <class Condition>
  static std::size_t first_from(const std::vector<std::string>& lines, std::size_t i, Condition holds) {
    while (i < lines.size() && !holds(lines[i])) ++i;
    return i;
  }

  void note(const std::string& key, const std::string& value, int line) {
    if (key == "not run")
      next_.skipped = true;
    else if (key == "long")
      next_.is_long = true;
    else if (key == "exit code")
      next_.exit_code = std::stoi(value);
    else if (key == "run" || key == "data")
      finish(key == "run" ? Block::Kind::command : Block::Kind::data, line, {value});
    else
      throw std::invalid_argument("line " + std::to_string(line) + ": unknown comment '" + key + "'");
  }

  void add(Block::Kind kind, const std::vector<std::string>& lines, std::size_t from, std::size_t to,
           std::size_t indent) {
    std::vector<std::string> text;
    for (std::size_t i = from; i < to; ++i)
      text.push_back(lines[i].substr(std::min(indent, lines[i].size())));
    finish(kind, int(from) + 1, text);
  }

  void finish(Block::Kind kind, int line, const std::vector<std::string>& text) {
    next_.kind = kind;
    next_.line = line;
    next_.text = text;
    blocks_.push_back(next_);
    next_ = Block{};
  }

  std::vector<Block> blocks_;
  Block next_{};
};

}  // namespace beamid::docs
