#include "experiments/text/matrix_market.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

constexpr double most_unknowns = 1e7, most_entries = 1e9;

/// Lines without comments, their words, and where they stand.
class MarketLines {
 public:
  MarketLines(const std::string& text, std::string file) : lines_(text), file_(std::move(file)) {}

  /// The words of the next line that holds any; empty at the end.
  std::vector<std::string> next() {
    std::string line;
    while (std::getline(lines_, line)) {
      ++number_;
      if (number_ > 1 && !line.empty() && line.front() == '%') continue;
      std::istringstream words(line);
      std::vector<std::string> found;
      for (std::string word; words >> word;) found.push_back(word);
      if (!found.empty()) return found;
    }
    ++number_;
    return {};
  }

  [[noreturn]] void refuse(const std::string& message) const {
    throw InputError(Place{file_, static_cast<std::size_t>(number_), 0}, message);
  }

  double number(const std::string& word, const char* what) const {
    double value = 0.0;
    const char* const first = word.data() + (word.front() == '+' ? 1 : 0);
    const auto [rest, error] = std::from_chars(first, word.data() + word.size(), value);
    if (error != std::errc() || rest != word.data() + word.size() || !std::isfinite(value))
      refuse(fmt::format("{} is '{}'; expected a number", what, word));
    return value;
  }

  int whole(const std::string& word, const char* what, double least, double most) const {
    const double value = number(word, what);
    if (value != std::floor(value) || value < least || value > most)
      refuse(fmt::format("{} is {}; expected a whole number from {:g} to {:g}", what, word, least, most));
    return static_cast<int>(value);
  }

 private:
  std::istringstream lines_;
  std::string file_;
  int number_ = 0;
};

struct MarketHeader {
  bool coordinate = true, symmetric = false;
};

MarketHeader read_header(MarketLines& lines) {
  std::vector<std::string> words = lines.next();
  for (std::string& word : words)
    for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool shape = words.size() == 5 && words[0] == "%%matrixmarket" && words[1] == "matrix" &&
                     (words[2] == "coordinate" || words[2] == "array") &&
                     (words[3] == "real" || words[3] == "integer" || words[3] == "double") &&
                     (words[4] == "general" || words[4] == "symmetric");
  if (!shape)
    lines.refuse(
        "no Matrix Market matrix that is known; expected '%%MatrixMarket matrix', then coordinate or array, "
        "real or integer, general or symmetric");
  return {words[2] == "coordinate", words[4] == "symmetric"};
}

Matrix read_entries(MarketLines& lines, const MarketHeader& header) {
  const std::vector<std::string> sizes = lines.next();
  if (sizes.size() != (header.coordinate ? 3U : 2U))
    lines.refuse(fmt::format("{} numbers; expected {}", sizes.size(),
                             header.coordinate ? "rows, columns and entries" : "rows and columns"));
  const int rows = lines.whole(sizes[0], "rows", 1, most_unknowns),
            columns = lines.whole(sizes[1], "columns", 1, most_unknowns);
  if (header.symmetric && rows != columns)
    lines.refuse(fmt::format("a symmetric matrix of {} x {}; expected a square one", rows, columns));
  const double dense = header.symmetric ? 0.5 * rows * (rows + 1.0) : 1.0 * rows * columns;
  const int count = header.coordinate ? lines.whole(sizes[2], "number of entries", 0, most_entries)
                    : dense <= most_entries
                        ? static_cast<int>(dense)
                        : (lines.refuse(fmt::format("{} x {} values; expected a coordinate matrix of so many",
                                                    rows, columns)),
                           0);
  std::vector<Eigen::Triplet<double>> entries;
  int row = 0, column = 0;
  for (int k = 0; k < count; ++k) {
    const std::vector<std::string> words = lines.next();
    const std::size_t expected = header.coordinate ? 3 : 1;
    if (words.empty()) lines.refuse(fmt::format("the file ends after {} of {} entries", k, count));
    if (words.size() != expected)
      lines.refuse(fmt::format("{} fields; expected {}", words.size(),
                               header.coordinate ? "row, column and value" : "one value"));
    if (header.coordinate) {
      row = lines.whole(words[0], "row", 1, rows) - 1;
      column = lines.whole(words[1], "column", 1, columns) - 1;
    }
    if (const double value = lines.number(words.back(), "value"); value != 0.0) {
      entries.emplace_back(row, column, value);
      if (header.symmetric && row != column) entries.emplace_back(column, row, value);
    }
    if (!header.coordinate && ++row == rows) ++column, row = header.symmetric ? column : 0;
  }
  if (!lines.next().empty()) lines.refuse(fmt::format("a line behind the last of {} entries", count));
  Matrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

Matrix parse_matrix_market(const std::string& text, const std::string& file) {
  MarketLines lines(text, file);
  const MarketHeader header = read_header(lines);
  return read_entries(lines, header);
}

Matrix read_matrix_market(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError({file.string()}, "cannot be read; expected a Matrix Market file");
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_matrix_market(text.str(), file.string());
}

}  // namespace beamid::experiments
