// The fields of one line of delimited text.
#pragma once

#include <string_view>
#include <vector>

namespace beamid::experiments {

/// Without blanks and tabs around it.
std::string_view trimmed(std::string_view text);

/// Without one pair of quotes around it.
std::string_view unquoted(std::string_view text);

/// The first of tab, semicolon, comma that occurs, else ' ' for blanks.
char separator_of(std::string_view line);

/// The trimmed fields of a line, views into it; separators at its end add none. ' ' stands for any run of
/// blanks and tabs.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

struct ParsedNumber {
  double value = 0;
  bool number = false;  ///< the whole field reads as a number, NaN and infinity included
  bool finite = false;  ///< and a double can hold it
};

/// A decimal number with a point, in whatever locale: -1, +.5, 2.5E-3.
ParsedNumber parse_number(std::string_view field);

/// The same with `decimal` between whole and fraction, '.' or ','.
ParsedNumber parse_number(std::string_view field, char decimal);

bool holds_number(const std::vector<std::string_view>& fields, char decimal = '.');
bool all_numbers(const std::vector<std::string_view>& fields, char decimal = '.');

}  // namespace beamid::experiments
