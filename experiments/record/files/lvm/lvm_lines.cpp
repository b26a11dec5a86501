#include "experiments/record/files/lvm/lvm_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/text/fields.hpp"

namespace beamid::experiments {

using std::string_view;

constexpr string_view end_of_header = "***End_of_Header***";

LvmLines::LvmLines(std::string file, string_view text) : file_(std::move(file)), rest_(text) {
  read_file_header();
}

bool LvmLines::next() {
  if (!next_line()) return false;
  split_fields(line_, separator_, fields_);
  return true;
}

bool LvmLines::next_line() {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(std::min(rest_.size(), end + (rest_.substr(end).starts_with("\r\n") ? 2 : 1)));
  ++number_;
  return true;
}

void LvmLines::read_file_header() {
  bool ended = false;
  char stated = '\t';
  while (!ended && next_line()) {
    if (number_ > 1)
      stated = line_.find('\t') != string_view::npos  ? '\t'
               : line_.find(',') != string_view::npos ? ','
                                                      : stated;
    split_fields(line_, stated, fields_);
    if (fields_.empty()) continue;
    ended = fields_[0] == end_of_header;
    const string_view value = fields_.size() > 1 ? fields_[1] : string_view();
    if (fields_[0] == "Separator") separator_ = value == "Comma" ? ',' : '\t';
    if (fields_[0] == "Decimal_Separator" && value == ",") decimal_ = ',';
    if (fields_[0] == "Decimal_Separator" && line_.ends_with(",")) decimal_ = ',';
  }
  if (!ended) throw bad(fmt::format("the file ends in its header; expected {}", end_of_header));
  if (separator_ == ',') decimal_ = '.';
}

bool LvmLines::begins_segment() const {
  static const char* const keys[] = {
      "Channels",    "Samples",  "Notes",   "Test_Name", "Test_Numbers",
      "Test_Series", "UUT_Name", "UUT_M/N", "UUT_S/N",   "***End_of_Header***"};
  return std::any_of(std::begin(keys), std::end(keys), [&](const char* key) { return fields_[0] == key; });
}

LvmSegment LvmLines::read_segment() {
  std::map<std::string, std::vector<std::string>, std::less<>> keys;
  bool special = false;
  for (bool ended = fields_[0] == end_of_header; !ended;) {
    if (!fields_.empty() && !special) {
      std::vector<std::string>& values = keys[std::string(fields_[0])];
      values.assign(fields_.begin() + 1, fields_.end());
    }
    if (!next_line())
      throw bad(fmt::format("the file ends in a segment's header; expected {}", end_of_header));
    split_fields(line_, separator_, fields_);
    if (fields_.empty()) continue;
    if (fields_[0].starts_with("***Start_Special***")) special = true;
    ended = fields_[0] == end_of_header;
    if (fields_[0].starts_with("***End_Special***")) special = false, fields_.clear();
  }
  const auto list = [&](const char* key) {
    const auto found = keys.find(key);
    return found == keys.end() ? std::vector<std::string>{} : found->second;
  };
  return {list("Y_Unit_Label"),     list("X_Dimension"),      list("X_Unit_Label"), numbers(list("X0")),
          numbers(list("Delta_X")), numbers(list("Samples")), {file_, number_, 1}};
}

std::vector<double> LvmLines::numbers(const std::vector<std::string>& words) const {
  std::vector<double> values;
  for (const std::string& word : words) {
    const ParsedNumber parsed = parse_number(word, decimal_);
    if (!parsed.finite) throw bad(fmt::format("'{}' in a segment's header; expected a number", word));
    values.push_back(parsed.value);
  }
  return values;
}

}  // namespace beamid::experiments
