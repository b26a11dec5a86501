#include "experiments/sweep/rows.hpp"

#include <algorithm>
#include <charconv>

#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

template <class Number>
bool read(std::string_view field, Number& number) {
  const char* const end = field.data() + field.size();
  const auto [rest, error] = std::from_chars(field.data(), end, number);
  return error == std::errc() && rest == end;
}

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

const std::vector<std::pair<const char*, double SweepRow::*>>& number_columns() {
  static const std::vector<std::pair<const char*, double SweepRow::*>> columns{
      {"estimate", &SweepRow::estimate},   {"truth", &SweepRow::truth},    {"error", &SweepRow::error},
      {"deviation", &SweepRow::deviation}, {"lower_95", &SweepRow::lower}, {"upper_95", &SweepRow::upper},
      {"bound", &SweepRow::bound}};
  return columns;
}

const std::vector<std::pair<const char*, std::string SweepRow::*>>& text_columns() {
  static const std::vector<std::pair<const char*, std::string SweepRow::*>> columns{
      {"reduction", &SweepRow::reduction},
      {"filter", &SweepRow::filter},
      {"discretisation", &SweepRow::discretisation},
      {"status", &SweepRow::status},
      {"parameter", &SweepRow::parameter},
      {"unit", &SweepRow::unit},
      {"reason", &SweepRow::reason}};
  return columns;
}

std::string header_line(const SweepPlan& plan) {
  std::string line = "case,row,rows,seed";
  for (const VariedKey& one : plan.varied) line += "," + csv_field(one.key);
  for (const auto& [name, member] : text_columns()) line.append(",").append(name);
  for (const auto& [name, member] : number_columns()) line.append(",").append(name);
  return line + "\n";
}

std::string to_line(const SweepRow& row) {
  std::string line = std::to_string(row.number) + "," + std::to_string(row.row) + "," +
                     std::to_string(row.rows) + "," + std::to_string(row.seed);
  for (const std::string& value : row.values) line += "," + csv_field(on_one_line(value));
  for (const auto& [name, member] : text_columns()) line += "," + csv_field(on_one_line(row.*member));
  for (const auto& [name, member] : number_columns()) line += "," + csv_field(row.*member);
  return line + "\n";
}

std::optional<SweepRow> from_line(std::string_view line, std::size_t values) {
  std::vector<std::string_view> fields;
  split_fields(line, ',', fields, true);
  constexpr std::size_t counts = 4;
  const std::size_t texts = text_columns().size(), numbers = number_columns().size();
  const bool torn = std::any_of(fields.begin(), fields.end(), [](std::string_view field) {
    return field.starts_with('"') && (field.size() < 2 || !field.ends_with('"'));
  });
  if (torn || fields.size() != counts + values + texts + numbers) return {};
  SweepRow row;
  if (!read(fields[0], row.number) || !read(fields[1], row.row) || !read(fields[2], row.rows) ||
      !read(fields[3], row.seed))
    return {};
  auto field = fields.begin() + counts;
  for (std::size_t j = 0; j < values; ++j) row.values.push_back(field_text(*field++));
  for (const auto& [name, member] : text_columns()) row.*member = field_text(*field++);
  for (const auto& [name, member] : number_columns()) {
    if (!field->empty() && !read(*field, row.*member)) return {};
    ++field;
  }
  return row;
}

}  // namespace beamid::experiments
