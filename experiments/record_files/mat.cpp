// MATLAB files of level 5 and 7.3, through matio.
#include <fmt/format.h>
#include <hdf5.h>
#include <matio.h>

#include <filesystem>
#include <memory>

#include "experiments/input/collected_signals.hpp"
#include "experiments/input/record_reader.hpp"
#include "experiments/input/text_file.hpp"

namespace beamid::experiments {
namespace {

struct Closing {
  void operator()(mat_t* file) const { Mat_Close(file); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};

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

class MatReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    return beginning.starts_with("MATLAB 5.0 MAT-file") || beginning.starts_with("MATLAB 7.3 MAT-file");
  }

  RecordTable read(const std::filesystem::path& path, const RecordFormat&) const override {
    const std::size_t size =
        count_bytes(path, "a MATLAB file");  // says in the usual words when there is none
    const std::string name = path.string();
    Mat_LogInitFunc("beamid", [](int, char*) {});
    H5dont_atexit();  // else HDF5, below level 7.3, complains at the end of what a damaged file left open
    const std::unique_ptr<mat_t, Closing> file(Mat_Open(name.c_str(), MAT_ACC_RDONLY));
    if (!file) throw InputError({name}, "no MATLAB file; expected one of level 5 or 7.3");
    constexpr std::size_t compression = 1100;  // more than zlib ever reaches
    most_numbers_ = size * compression / 8 + 64;
    CollectedSignals signals(name);
    while (const std::unique_ptr<matvar_t, Closing> found{Mat_VarReadNextInfo(file.get())}) {
      const bool is_struct = found->class_type == MAT_C_STRUCT;
      if (found->name == nullptr || (!is_numeric(*found) && !is_struct)) continue;
      refuse_huge(name, *found);
      Mat_VarReadDataAll(file.get(), found.get());
      if (!is_struct) {
        add(*found, found->name, signals);
        continue;
      }
      const unsigned fields = Mat_VarGetNumberOfFields(found.get());
      char* const* const names = Mat_VarGetStructFieldnames(found.get());
      for (unsigned k = 0; names != nullptr && k < fields; ++k) {
        const matvar_t* const field = Mat_VarGetStructFieldByIndex(found.get(), k, 0);
        if (field != nullptr && is_numeric(*field))
          add(*field, fmt::format("{}.{}", found->name, names[k]), signals);
      }
    }
    return signals.table();
  }

 private:
  void refuse_huge(const std::string& name, const matvar_t& variable) const {
    double count = 1;
    for (int d = 0; variable.dims != nullptr && d < variable.rank; ++d)
      count *= static_cast<double>(variable.dims[d]);
    if (count > static_cast<double>(most_numbers_))
      throw InputError({name},
                       fmt::format("'{}' claims {:.3g} numbers; expected no more than the file can hold",
                                   variable.name, count));
  }

  void add(const matvar_t& variable, const std::string& name, CollectedSignals& signals) const {
    if (variable.rank != 2 || variable.data == nullptr || variable.dims == nullptr) return;
    const std::size_t rows = variable.dims[0], columns = variable.dims[1];
    if (rows == 0 || columns == 0 || rows > most_numbers_ / columns) return;
    const std::size_t count = rows * columns;
    if (variable.data_size <= 0 || variable.nbytes < count * static_cast<std::size_t>(variable.data_size))
      return;
    const std::vector<double> values = numbers(variable, count);
    if (values.empty()) return;
    const int digits = variable.class_type == MAT_C_SINGLE ? 7 : 15;
    if (count == 1)
      signals.set(name, values[0]);
    else if (rows == 1 || columns == 1)
      signals.add(name, "", values, digits);
    else
      signals.add_matrix(
          [&](std::size_t k, bool is_row) {
            return is_row ? fmt::format("{}({},:)", name, k) : fmt::format("{}(:,{})", name, k);
          },
          "", values, rows, columns, digits);
  }

  mutable std::size_t most_numbers_ = 0;
};

const bool registered = record_reader_registry().add(
    {"mat",
     "MATLAB files of level 5 and 7.3: vectors, columns of matrices, fields of structs",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<MatReader>(); }});

}  // namespace
}  // namespace beamid::experiments
