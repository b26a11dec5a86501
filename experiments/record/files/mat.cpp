// MATLAB files of level 4, 5 and 7.3, through matio.
#include <fmt/format.h>
#include <matio.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <memory>

#include <needed_library.hpp>

#include "experiments/record/files/hdf5/handle.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
// The functions of matio, loaded when a MATLAB file is read.

constexpr NeededLibrary matio{BEAMID_MATIO};
BEAMID_NEEDED(matio, Mat_Open);
BEAMID_NEEDED(matio, Mat_Close);
BEAMID_NEEDED(matio, Mat_GetVersion);
BEAMID_NEEDED(matio, Mat_LogInitFunc);
BEAMID_NEEDED(matio, Mat_VarFree);
BEAMID_NEEDED(matio, Mat_VarReadNextInfo);
BEAMID_NEEDED(matio, Mat_VarReadDataAll);
BEAMID_NEEDED(matio, Mat_VarGetCell);
BEAMID_NEEDED(matio, Mat_VarGetNumberOfFields);
BEAMID_NEEDED(matio, Mat_VarGetStructFieldnames);
BEAMID_NEEDED(matio, Mat_VarGetStructFieldByIndex);

/// Closes a file and frees a variable of matio, for std::unique_ptr.
struct MatioDeleter {
  void operator()(mat_t* file) const { Mat_Close(file); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};

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

/// Level 4 has no words at its beginning: five numbers of 4 bytes (kind, rows, columns, whether complex,
/// length of the name), then the name, which ends with a zero.
bool is_level_four(std::string_view beginning) {
  constexpr std::size_t header = 20, word = 4;
  constexpr std::uint32_t most_kinds = 52, big_endian = 1000, longest_name = 64;
  if (beginning.size() < header + 2) return false;
  for (const bool swapped : {false, true}) {
    std::uint32_t numbers[5];
    for (std::size_t k = 0; k < 5; ++k)
      numbers[k] = number_of_bytes<std::uint32_t>(beginning.data() + word * k, swapped);
    const auto [kind, rows, columns, complex, length] = numbers;
    const std::uint32_t low = kind - (swapped ? big_endian : 0);
    if (low > most_kinds || low % 10 > 2 || rows == 0 || columns == 0 || complex > 1 || length < 2 ||
        length > longest_name || header + length > beginning.size())
      continue;
    const std::string_view name = beginning.substr(header, length - 1);
    if (beginning[header + length - 1] == '\0' && name.find_first_of("0123456789_") != 0 &&
        std::ranges::all_of(name,
                            [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)); }))
      return true;
  }
  return false;
}

/// Of a variable of characters in one row; empty: of another form.
std::string text_of(const matvar_t& variable) {
  constexpr std::size_t longest = 256;
  if (variable.rank != 2 || variable.dims == nullptr || variable.data == nullptr || variable.dims[0] != 1 ||
      variable.dims[1] > longest || variable.data_size <= 0)
    return "";
  const auto width = static_cast<std::size_t>(variable.data_size);
  const std::size_t count = std::min(variable.nbytes / width, longest);
  const auto* const bytes = static_cast<const unsigned char*>(variable.data);
  std::string text;
  for (std::size_t k = 0; k < count; ++k) {
    const unsigned letter = bytes[k * width] + (width > 1 ? 256U * bytes[k * width + 1] : 0U);
    if (letter == 0) break;
    if (letter < 0x80 || width == 1)
      text += static_cast<char>(letter);
    else if (letter < 0x800)
      text += {static_cast<char>(0xC0 | letter >> 6), static_cast<char>(0x80 | (letter & 0x3F))};
    else
      text += {static_cast<char>(0xE0 | letter >> 12), static_cast<char>(0x80 | (letter >> 6 & 0x3F)),
               static_cast<char>(0x80 | (letter & 0x3F))};
  }
  return text;
}

class MatReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    return beginning.starts_with("MATLAB 5.0 MAT-file") || beginning.starts_with("MATLAB 7.3 MAT-file") ||
           is_level_four(beginning);
  }

  RecordTable read(const std::filesystem::path& path, const RecordFormat& format) const override {
    const std::string name = path.string();
    const std::size_t size =
        count_bytes(path, "a MATLAB file");  // says in the usual words when there is none
    return read_apart(name, "matio", reading_limits(size), collect).table(format);
  }

 private:
  static void collect(CollectedSignals& signals) {
    const auto file = opened(signals.file());
    while (const std::unique_ptr<matvar_t, MatioDeleter> found{Mat_VarReadNextInfo(file.get())}) {
      const bool holds_others = found->class_type == MAT_C_STRUCT || found->class_type == MAT_C_CELL;
      const bool holds_text = found->class_type == MAT_C_CHAR;
      if (found->name == nullptr || (!is_numeric(*found) && !holds_others && !holds_text)) continue;
      announce(*found, found->name, signals);
      Mat_VarReadDataAll(file.get(), found.get());
      add(*found, found->name, 0, signals);
    }
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
      signals.add_text(name, text_of(variable));
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
    if (count == 1)
      signals.set(name, values[0]);
    else
      signals.add_variable(name, std::move(values), rows, columns, digits);
  }
};

const bool mat_registered =
    record_reader_registry().add({"mat",
                                  "MATLAB files of level 4, 5 and 7.3: vectors, columns of matrices, fields "
                                  "of structs of any depth, cells",
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
