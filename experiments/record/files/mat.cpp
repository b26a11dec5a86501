// MATLAB files of level 4, 5 and 7.3, through matio, and the text that Octave saves.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>

#include "experiments/record/files/hdf5/handle.hpp"
#include "experiments/record/files/matio.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

std::unique_ptr<mat_t, MatioDeleter> opened(const std::string& name) {
  Mat_LogInitFunc("beamid", [](int, auto*) {});
  std::unique_ptr<mat_t, MatioDeleter> file(Mat_Open(name.c_str(), MAT_ACC_RDONLY));
  if (!file) throw InputError({name}, "no MATLAB file; expected one of level 4, 5 or 7.3");
  if (Mat_GetVersion(file.get()) == MAT_FT_MAT73) require_own_storage(name);
  return file;
}

bool is_numeric(const matvar_t& variable) {
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
    case MAT_C_SINGLE:
    case MAT_C_INT8:
    case MAT_C_UINT8:
    case MAT_C_INT16:
    case MAT_C_UINT16:
    case MAT_C_INT32:
    case MAT_C_UINT32:
    case MAT_C_INT64:
    case MAT_C_UINT64:
      return !variable.isComplex;
    default:
      return false;
  }
}

template <class Number>
std::vector<double> widened(const matvar_t& variable, std::size_t count) {
  const auto* const first = static_cast<const Number*>(variable.data);
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<double>(first[i]);
  return values;
}

std::vector<double> numbers(const matvar_t& variable, std::size_t count) {
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      return widened<double>(variable, count);
    case MAT_T_SINGLE:
      return widened<float>(variable, count);
    case MAT_T_INT8:
      return widened<std::int8_t>(variable, count);
    case MAT_T_UINT8:
      return widened<std::uint8_t>(variable, count);
    case MAT_T_INT16:
      return widened<std::int16_t>(variable, count);
    case MAT_T_UINT16:
      return widened<std::uint16_t>(variable, count);
    case MAT_T_INT32:
      return widened<std::int32_t>(variable, count);
    case MAT_T_UINT32:
      return widened<std::uint32_t>(variable, count);
    case MAT_T_INT64:
      return widened<std::int64_t>(variable, count);
    case MAT_T_UINT64:
      return widened<std::uint64_t>(variable, count);
    default:
      return {};
  }
}

/// A file of level 4 begins with its first matrix: type, rows, columns, whether it is complex, and the length
/// of its name, four bytes each, then the name.
bool is_level_4(std::string_view beginning) {
  constexpr std::size_t sizes = 20, longest_name = 64, precisions = 6;
  if (beginning.size() < sizes) return false;
  const auto number = [&](std::size_t place, bool swapped) {
    return number_of_bytes<std::uint32_t>(beginning.data() + 4 * place, swapped);
  };
  for (const bool swapped : {false, true}) {
    const std::uint32_t order = swapped ? 1000 : 0, type = number(0, swapped) - order,
                        length = number(4, swapped);
    if (type % 10 > 1 || type / 10 >= precisions || number(1, swapped) == 0 || number(2, swapped) == 0 ||
        number(3, swapped) > 1 || length < 2 || length > longest_name || beginning.size() < sizes + length)
      continue;
    const std::string_view name = beginning.substr(sizes, length);
    const bool is_name = std::ranges::all_of(
        name.substr(0, length - 1), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (is_name && name.back() == '\0') return true;
  }
  return false;
}

/// The letters of a text.
std::string letters(const matvar_t& variable, std::size_t count) {
  std::string text;
  const std::size_t size = variable.data_size == 2 ? 2 : 1;
  if (variable.nbytes < count * size) return text;
  const auto* const first = static_cast<const char*>(variable.data);
  for (std::size_t i = 0; i < count; ++i) text += first[i * size];  // the low byte of UTF-16 first
  return text;
}

/// A matrix stored column by column: a number of its own, one signal, or several.
void add_matrix(const std::string& name, std::vector<double> values, std::size_t rows, std::size_t columns,
                int digits, CollectedSignals& signals) {
  if (values.size() == 1)
    signals.set(name, values[0]);
  else if (rows == 1 || columns == 1)
    signals.add(name, "", std::move(values), digits);
  else
    signals.add_matrix(
        [&](std::size_t k, bool is_row) {
          return is_row ? fmt::format("{}({},:)", name, k) : fmt::format("{}(:,{})", name, k);
        },
        "", values, rows, columns, digits);
}

constexpr std::string_view octave_beginning = "# Created by Octave";

/// "# name: acc", "# type: matrix", "# rows: 3", "# columns: 2", rows of numbers, and so on.
class OctaveText {
 public:
  OctaveText(const std::string& text, CollectedSignals& signals) : lines_(text), signals_(signals) {
    std::string name, type, line;
    while (std::getline(lines_, line)) {
      if (const auto named = value_of(line, "name")) name = *named;
      const auto kind = value_of(line, "type");
      if (!kind || name.empty()) continue;
      if (*kind == "scalar" || *kind == "float scalar") {
        if (std::getline(lines_, line)) signals_.set(name, number(line));
      } else if (*kind == "matrix" || *kind == "float matrix") {
        take_matrix(name);
      } else if (*kind == "range" || *kind == "double_range") {
        take_range(name);
      } else if (*kind == "string" || *kind == "sq_string") {
        take_text(name);
      }
    }
    signals_.take_units();
  }

 private:
  static std::optional<std::string> value_of(const std::string& line, const std::string& key) {
    const std::string start = "# " + key + ": ";
    if (!line.starts_with(start)) return {};
    return line.substr(start.size(), line.find_last_not_of("\r ") + 1 - start.size());
  }

  static double number(const std::string& text) {
    const std::size_t from = text.find_first_not_of(' ');
    return from == std::string::npos ? std::nan("") : parse_number(text.substr(from)).value;
  }

  std::size_t size_of_next(const std::string& key) {
    std::string line;
    if (!std::getline(lines_, line)) return 0;
    const auto stated = value_of(line, key);
    return stated ? static_cast<std::size_t>(std::max(0.0, number(*stated))) : 0;
  }

  void take_matrix(const std::string& name) {
    const std::size_t rows = size_of_next("rows"), columns = size_of_next("columns");
    signals_.announce(name, {rows, columns});
    std::vector<double> values(rows * columns);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j) {
        std::string field;
        if (!(lines_ >> field))
          throw InputError(
              {signals_.file()},
              fmt::format("'{}' ends in row {}; expected {} rows of {} numbers", name, i + 1, rows, columns));
        values[i + j * rows] = parse_number(field).value;
      }
    add_matrix(name, std::move(values), rows, columns, 15, signals_);
  }

  void take_range(const std::string& name) {
    std::string line;
    std::getline(lines_, line);  // "# base, limit, increment"
    double base = 0.0, limit = 0.0, increment = 0.0;
    if (!(lines_ >> base >> limit >> increment) || !(increment > 0.0) || !(limit > base)) return;
    const auto count = static_cast<std::size_t>((limit - base) / increment * (1.0 + 1e-12)) + 1;
    signals_.announce(name, {count});
    std::vector<double> values(count);
    for (std::size_t k = 0; k < count; ++k) values[k] = base + increment * static_cast<double>(k);
    signals_.add(name, "", std::move(values), 15);
  }

  void take_text(const std::string& name) {
    std::string line;
    if (size_of_next("elements") != 1 || size_of_next("length") == 0 || !std::getline(lines_, line)) return;
    signals_.set_text(name, line);
  }

  std::istringstream lines_;
  CollectedSignals& signals_;
};

class MatReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    return beginning.starts_with("MATLAB 5.0 MAT-file") || beginning.starts_with("MATLAB 7.3 MAT-file") ||
           beginning.starts_with(octave_beginning) || is_level_4(beginning);
  }

  RecordTable read(const std::filesystem::path& path, const RecordFormat& format) const override {
    const std::string name = path.string();
    const std::size_t size =
        count_bytes(path, "a MATLAB file");  // says in the usual words when there is none
    std::ifstream stream = open_input(path, "a MATLAB file");
    std::string beginning(octave_beginning.size(), ' ');
    if (stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size())) &&
        beginning == octave_beginning) {
      CollectedSignals signals(name, reading_limits(size).numbers);
      OctaveText({std::istreambuf_iterator<char>(stream), {}}, signals);
      return signals.table(format);
    }
    return read_apart(name, "matio", reading_limits(size), collect).table(format);
  }

 private:
  static void collect(CollectedSignals& signals) {
    const auto file = opened(signals.file());
    while (const std::unique_ptr<matvar_t, MatioDeleter> found{Mat_VarReadNextInfo(file.get())}) {
      const bool holds_others = found->class_type == MAT_C_STRUCT || found->class_type == MAT_C_CELL ||
                                found->class_type == MAT_C_CHAR;
      if (found->name == nullptr || (!is_numeric(*found) && !holds_others)) continue;
      announce(*found, found->name, signals);
      Mat_VarReadDataAll(file.get(), found.get());
      add(*found, found->name, 0, signals);
    }
    signals.take_units();
  }

  static std::vector<std::size_t> extent(const matvar_t& variable) {
    if (variable.dims == nullptr || variable.rank < 1) return {};
    return {variable.dims, variable.dims + variable.rank};
  }

  static std::size_t elements(const matvar_t& variable) {
    std::size_t count = 1;
    for (const std::size_t size : extent(variable)) count *= size;
    return count;
  }

  static void announce(const matvar_t& variable, const std::string& name, CollectedSignals& signals) {
    signals.announce(name, extent(variable));
  }

  /// A variable, or whatever lies within it: "data.hammer", "run(2).tip.x", "channel{3}".
  static void add(matvar_t& variable, const std::string& name, int depth, CollectedSignals& signals) {
    constexpr int deepest = 64;
    if (depth > deepest)
      throw InputError({signals.file()},
                       fmt::format("structs within structs, more than {}; expected fewer", deepest));
    if (variable.data == nullptr) return;
    const std::size_t count = elements(variable);
    if (variable.class_type == MAT_C_CELL) {
      for (std::size_t k = 0; k < count; ++k)
        if (matvar_t* const cell = Mat_VarGetCell(&variable, static_cast<int>(k)))
          add(*cell, fmt::format("{}{{{}}}", name, k + 1), depth + 1, signals);
    } else if (variable.class_type == MAT_C_STRUCT) {
      add_fields(variable, name, count, depth, signals);
    } else if (variable.class_type == MAT_C_CHAR) {
      signals.set_text(name, letters(variable, count));
    } else if (is_numeric(variable)) {
      if (depth > 0) announce(variable, name, signals);
      add_numbers(variable, name, signals);
    }
  }

  static void add_fields(matvar_t& variable, const std::string& name, std::size_t count, int depth,
                         CollectedSignals& signals) {
    const unsigned fields = Mat_VarGetNumberOfFields(&variable);
    char* const* const names = Mat_VarGetStructFieldnames(&variable);
    for (std::size_t k = 0; k < count; ++k)
      for (unsigned f = 0; names != nullptr && f < fields; ++f)
        if (matvar_t* const field = Mat_VarGetStructFieldByIndex(&variable, f, k))
          add(*field,
              count == 1 ? fmt::format("{}.{}", name, names[f])
                         : fmt::format("{}({}).{}", name, k + 1, names[f]),
              depth + 1, signals);
  }

  static void add_numbers(const matvar_t& variable, const std::string& name, CollectedSignals& signals) {
    if (variable.rank != 2 || variable.dims == nullptr) return;
    const std::size_t rows = variable.dims[0], columns = variable.dims[1], count = rows * columns;
    if (count == 0 || variable.data_size <= 0 ||
        variable.nbytes < count * static_cast<std::size_t>(variable.data_size))
      return;
    std::vector<double> values = numbers(variable, count);
    if (values.empty()) return;
    const int digits = variable.class_type == MAT_C_SINGLE ? 7 : 15;
    add_matrix(name, std::move(values), rows, columns, digits, signals);
  }
};

const bool mat_registered =
    record_reader_registry().add({"mat",
                                  "MATLAB files of level 4, 5 and 7.3, and Octave's text: vectors, columns "
                                  "of matrices, fields of structs of "
                                  "any depth, cells",
                                  "",
                                  {},
                                  {},
                                  [](const filters::Options&) { return std::make_unique<MatReader>(); }});

}  // namespace
// Matrices of a structure.

namespace {

bool is_matrix(const matvar_t& found) {
  return found.name != nullptr && found.rank == 2 && found.dims != nullptr && !found.isComplex &&
         (found.class_type == MAT_C_DOUBLE || found.class_type == MAT_C_SPARSE);
}

// What the child sends of it: sizes, then row, column and value of every entry that is not zero.
void add_full(const matvar_t& variable, std::vector<double>& rows, std::vector<double>& columns,
              std::vector<double>& values) {
  const auto* const numbers = static_cast<const double*>(variable.data);
  const std::size_t n = variable.dims[0], m = variable.dims[1];
  if (numbers == nullptr || variable.data_type != MAT_T_DOUBLE || variable.nbytes < n * m * sizeof(double))
    return;
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t i = 0; i < n; ++i)
      if (const double value = numbers[i + j * n]; value != 0.0) {
        rows.push_back(static_cast<double>(i));
        columns.push_back(static_cast<double>(j));
        values.push_back(value);
      }
}

void add_sparse(const matvar_t& variable, std::vector<double>& rows, std::vector<double>& columns,
                std::vector<double>& values) {
  const auto* const sparse = static_cast<const mat_sparse_t*>(variable.data);
  if (sparse == nullptr || sparse->data == nullptr || sparse->ir == nullptr || sparse->jc == nullptr ||
      variable.data_type != MAT_T_DOUBLE || sparse->njc != variable.dims[1] + 1)
    return;
  const auto* const numbers = static_cast<const double*>(sparse->data);
  for (std::size_t j = 0; j < variable.dims[1]; ++j)
    for (std::size_t k = sparse->jc[j]; k < sparse->jc[j + 1]; ++k) {
      if (k >= sparse->nir || k >= sparse->ndata || sparse->ir[k] >= variable.dims[0]) return;
      rows.push_back(static_cast<double>(sparse->ir[k]));
      columns.push_back(static_cast<double>(j));
      values.push_back(numbers[k]);
    }
}

void collect_matrices(CollectedSignals& signals, const std::string& wanted) {
  const auto file = opened(signals.file());
  while (const std::unique_ptr<matvar_t, MatioDeleter> found{Mat_VarReadNextInfo(file.get())}) {
    if (!is_matrix(*found) || (!wanted.empty() && wanted != found->name)) continue;
    const std::string own = found->name;
    if (found->class_type == MAT_C_DOUBLE) signals.announce(own, {found->dims[0], found->dims[1]});
    Mat_VarReadDataAll(file.get(), found.get());
    std::vector<double> rows, columns, values;
    if (found->class_type == MAT_C_SPARSE)
      add_sparse(*found, rows, columns, values);
    else
      add_full(*found, rows, columns, values);
    signals.add_numbers(own, "", {static_cast<double>(found->dims[0]), static_cast<double>(found->dims[1])},
                        15);
    signals.add_numbers("rows", "", std::move(rows), 15);
    signals.add_numbers("columns", "", std::move(columns), 15);
    signals.add_numbers("values", "", std::move(values), 15);
  }
}

}  // namespace

Eigen::SparseMatrix<double> read_mat_matrix(const std::filesystem::path& file, const std::string& variable) {
  constexpr std::size_t parts = 4;
  const std::size_t size = count_bytes(file, "a MATLAB file");
  const CollectedSignals found =
      read_apart(file.string(), "matio", reading_limits(size),
                 [&](CollectedSignals& signals) { collect_matrices(signals, variable); });
  const auto& signals = found.signals();
  if (signals.size() != parts)
    throw InputError({file.string()},
                     signals.empty()
                         ? fmt::format("no real matrix{}; expected one of double precision, full or sparse",
                                       variable.empty() ? "" : " '" + variable + "'")
                         : fmt::format("{} matrices; expected the name of one behind the file's, \"{}:{}\"",
                                       signals.size() / parts, file.filename().string(), signals[0].name));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < signals[3].values.size(); ++k)
    entries.emplace_back(static_cast<int>(signals[1].values[k]), static_cast<int>(signals[2].values[k]),
                         signals[3].values[k]);
  Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(signals[0].values[0]),
                                     static_cast<Eigen::Index>(signals[0].values[1]));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace beamid::experiments
