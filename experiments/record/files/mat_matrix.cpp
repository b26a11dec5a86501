#include "experiments/record/files/mat_matrix.hpp"

#include <fmt/format.h>

#include <memory>

#include "experiments/record/files/hdf5/handle.hpp"
#include "experiments/record/files/matio.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
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
  const std::string& name = signals.file();
  Mat_LogInitFunc("beamid", [](int, auto*) {});
  const std::unique_ptr<mat_t, MatioDeleter> file(Mat_Open(name.c_str(), MAT_ACC_RDONLY));
  if (!file) throw InputError({name}, "no MATLAB file; expected one of level 5 or 7.3");
  if (Mat_GetVersion(file.get()) == MAT_FT_MAT73) require_own_storage(name);
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
    signals.add(own, "", {static_cast<double>(found->dims[0]), static_cast<double>(found->dims[1])}, 15);
    signals.add("rows", "", std::move(rows), 15);
    signals.add("columns", "", std::move(columns), 15);
    signals.add("values", "", std::move(values), 15);
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
