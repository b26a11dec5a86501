#include "experiments/config/key_page.hpp"

#include <fmt/format.h>

#include <set>

#include "experiments/text/words.hpp"

namespace beamid::experiments {
namespace {

/// The word between the first two backticks of a line; empty without.
std::string quoted_word(const std::string& line) {
  const std::size_t first = line.find('`'), last = line.find('`', first + 1);
  return last == std::string::npos ? "" : line.substr(first + 1, last - first - 1);
}

const KeyTable* table_under(const std::string& heading) {
  if (heading == "### The file itself") return find_key_table("");
  std::string table = quoted_word(heading);
  std::erase_if(table, [](char letter) { return letter == '[' || letter == ']'; });
  return table.empty() ? nullptr : find_key_table(table);
}

class PageOfKeys {
 public:
  void take(const std::string& line) {
    if (line.starts_with("#")) {
      finish();
      section_ = table_under(line);
    }
    if (section_ == nullptr || !line.starts_with("| `")) {
      lines_.push_back(line);
      if (end_of_rows_ == 0 && line.starts_with("|---")) end_of_rows_ = lines_.size();  // of none yet
      return;
    }
    const Key* const key = section_->find(quoted_word(line));
    if (key == nullptr || key->is_table() || !shown_.insert(key->name).second) return;
    lines_.push_back(page_row(*key));
    end_of_rows_ = lines_.size();
  }

  std::string text() {
    finish();
    std::string text;
    for (const std::string& line : lines_) text += (&line == &lines_.front() ? "" : "\n") + line;
    return text;
  }

 private:
  std::vector<std::string> lines_;
  const KeyTable* section_ = nullptr;
  std::set<std::string> shown_;
  std::size_t end_of_rows_ = 0;

  void finish() {
    if (section_ != nullptr && end_of_rows_ != 0)
      for (const Key& key : section_->keys())
        if (!key.is_table() && !shown_.contains(key.name))
          lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(end_of_rows_++), page_row(key));
    section_ = nullptr;
    shown_.clear();
    end_of_rows_ = 0;
  }
};

}  // namespace

std::string page_row(const Key& key) {
  return fmt::format("| `{}` | {} | {} | {} | {} | `{}` |", key.name, values_text(key), unit_in_key(key.name),
                     key.fallback, key.meaning, key.example);
}

std::string with_current_keys(const std::string& page) {
  PageOfKeys keys;
  for (const std::string& line : split(page, '\n')) keys.take(line);
  return keys.text();
}

}  // namespace beamid::experiments
