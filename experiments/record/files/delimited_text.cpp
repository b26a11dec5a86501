// Rows of numbers in columns: the text export of nearly every analyser.
#include "experiments/record/delimited_text.hpp"

#include <cmath>
#include <memory>
#include <string>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

class DelimitedTextReader final : public RecordReader {
 public:
  /// Whatever no other reader knows is taken for text, and refused in its words.
  bool recognises(std::string_view) const override { return false; }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    const auto content =
        std::make_shared<const std::string>(read_text(file, "a record of numbers in columns"));
    DelimitedText text(file.string(), *content, format.separator, format.header_lines, format.decimal,
                       format.malformed == MalformedRows::skip);
    RecordTable table;
    table.file = file.string();
    table.names = text.names();
    table.by_people = true;
    table.units = text.units();
    table.header_line = text.header_line();
    table.columns.resize(text.width());
    table.precision.resize(text.width());
    TextCells cells(table.file, content);
    std::string token;
    std::vector<std::optional<double>> first_stamp(
        text.width());  // whole seconds: a double holds the rest finely
    constexpr double half_a_day = 43200.0;
    std::vector<double> days(text.width(), 0.0);  // that have passed [s]
    while (text.next()) {
      cells.add(text.line(), text.line_number());
      table.lines.push_back(text.line_number());
      for (std::size_t column = 0; column < text.width(); ++column) {
        table.columns[column].push_back(text.value(column));
        token = text.field(column);
        if (!std::isfinite(table.columns[column].back())) {
          const std::string_view field = unquoted(token);
          if (const auto of_day = seconds_of_day(field)) {  // past midnight the days go on
            double& value = table.columns[column].back();
            value = *of_day + days[column];
            const std::size_t rows = table.columns[column].size();
            if (rows > 1 && value < table.columns[column][rows - 2] - half_a_day)
              value += 2.0 * half_a_day, days[column] += 2.0 * half_a_day;
            if (!table.time && table.lines.size() == 1) table.time = column;
            const std::size_t point = token.find_last_of(".,");
            token = "10000" + (point == std::string::npos ? "" : token.substr(point));
          } else if (is_date(field)) {
            table.columns[column].back() = 0.0;
          } else if (const auto stamp = seconds_of_stamp(unquoted(token))) {
            if (!first_stamp[column]) first_stamp[column] = std::floor(*stamp);
            table.columns[column].back() = *stamp - *first_stamp[column];
            if (!table.time && table.lines.size() == 1) table.time = column;
            // What a stamp's printing shows: its fraction, behind as many digits as seconds since 1970 have.
            const std::size_t point = token.find_last_of(".,");
            token = "1000000000" + (point == std::string::npos
                                        ? ""
                                        : token.substr(point, token.find_first_of("Z+", point) - point));
          }
        }
        if (text.decimal() == ',')
          for (char& sign : token) sign = sign == ',' ? '.' : sign;
        if (std::isfinite(table.columns[column].back())) table.precision[column].add(token);
      }
    }
    table.cell = cells.cells(text.separator());
    if (!table.time)
      if (const auto rate = stated_rate(content->substr(0, std::min<std::size_t>(content->size(), 2000))))
        table.stated_rate = rate;
    table.skipped_lines = text.skipped_lines();
    if (text.decimal() == ',') table.remarks.emplace_back("Its numbers have a decimal comma.");
    return table;
  }
};

const bool delimited_text_registered = record_reader_registry().add(
    {"delimited_text",
     "rows of numbers in columns parted by tabs, semicolons, commas or blanks",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<DelimitedTextReader>(); }});

}  // namespace
}  // namespace beamid::experiments
