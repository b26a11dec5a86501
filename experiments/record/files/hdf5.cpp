// HDF5 files, those of netCDF-4 too: one- and two-dimensional datasets by their path, and fields of records.
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/record/files/hdf5/handle.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

// Whether a file holds its numbers itself (handle.hpp).

struct StorageWalk {
  std::string file;
  std::optional<InputError> failure;
};

[[noreturn]] void refuse_storage(const std::string& file, const std::string& path) {
  throw InputError({file},
                   fmt::format("'{}' takes its numbers from another file; expected them in this one", path));
}

herr_t visit_object(hid_t root, const char* name, const H5O_info_t* info, void* data) {
  StorageWalk& walk = *static_cast<StorageWalk*>(data);
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Handle dataset(H5Oopen(root, name, H5P_DEFAULT), H5Oclose);
  try {
    if (dataset.open()) require_own_storage(dataset, name, walk.file);
  } catch (const InputError& error) {
    walk.failure = error;
    return 1;
  }
  return 0;
}

herr_t visit_link(hid_t, const char* name, const H5L_info_t* info, void* data) {
  StorageWalk& walk = *static_cast<StorageWalk*>(data);
  if (info->type != H5L_TYPE_EXTERNAL) return 0;
  walk.failure = InputError({walk.file}, fmt::format("'{}' is a link to another file; expected none", name));
  return 1;
}

}  // namespace

void require_own_storage(hid_t dataset, const std::string& path, const std::string& file) {
  const Handle created(H5Dget_create_plist(dataset), H5Pclose);
  if (created.open() && (H5Pget_layout(created) == H5D_VIRTUAL || H5Pget_external_count(created) > 0))
    refuse_storage(file, path);
}

void require_own_storage(const std::string& file) {
  const Quiet quiet;
  const Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  StorageWalk walk{file, std::nullopt};
  const bool walked = opened.open() && H5Lvisit(opened, H5_INDEX_NAME, H5_ITER_INC, visit_link, &walk) >= 0 &&
                      (walk.failure || H5Ovisit2(opened, H5_INDEX_NAME, H5_ITER_INC, visit_object, &walk,
                                                 H5O_INFO_BASIC) >= 0);
  if (walk.failure) throw InputError(*walk.failure);
  if (!walked) throw InputError({file}, "cannot be walked through by HDF5; expected an undamaged file");
}

namespace {

/// Of an attribute, one number of it alone.
std::optional<double> number_of(hid_t attribute) {
  const Handle space(H5Aget_space(attribute), H5Sclose), type(H5Aget_type(attribute), H5Tclose);
  const H5T_class_t kind = type.open() ? H5Tget_class(type) : H5T_NO_CLASS;
  if (!space.open() || H5Sget_simple_extent_npoints(space) != 1 || (kind != H5T_FLOAT && kind != H5T_INTEGER))
    return std::nullopt;
  double value = 0.0;
  if (H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0) return std::nullopt;
  return value;
}

/// A text alone, of an attribute or of a dataset. @param read into memory
template <class Read>
std::string text_of(hid_t type, hid_t space, const Read& read) {
  if (space < 0 || type < 0 || H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1)
    return "";
  std::string text;
  if (H5Tis_variable_str(type) > 0) {
    char* value = nullptr;
    if (read(&value) >= 0 && value != nullptr) text = value;
    if (value != nullptr) H5free_memory(value);
  } else {
    constexpr std::size_t longest = 4096;
    const std::size_t size = H5Tget_size(type);
    if (size == 0 || size > longest) return "";
    text.assign(size, '\0');
    if (read(text.data()) < 0) return "";
    text.resize(std::min(text.find('\0'), text.size()));
  }
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

struct Walk {
  CollectedSignals& signals;
  std::exception_ptr failure = nullptr;  // none may pass through HDF5
};

/// What the attributes of an object state: of sampling and units, and how packed numbers are scaled.
struct Attributes {
  std::string unit;
  double scale = 1.0, offset = 0.0;
};

Attributes take_attributes(Walk& walk, hid_t object, const std::string& path) {
  constexpr hsize_t most = 1000;
  Attributes found;
  for (hsize_t k = 0; k < most; ++k) {
    const Handle attribute(
        H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, k, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!attribute.open()) break;
    char name[256] = "";
    if (H5Aget_name(attribute, sizeof name, name) < 0) continue;
    if (const auto value = number_of(attribute)) {
      if (*value > 0.0 && std::isfinite(*value)) walk.signals.set(path + "/" + name, *value);
      if (std::string_view(name) == "scale_factor" && *value != 0.0) found.scale = *value;
      if (std::string_view(name) == "add_offset") found.offset = *value;
      continue;
    }
    const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
    const std::string text = text_of(type, space, [&](void* to) { return H5Aread(attribute, type, to); });
    if (folded(name) == "units" || folded(name) == "unit") found.unit = text;
    walk.signals.add_text(path + "/" + name, text);
  }
  return found;
}

/// The fields of records that are numbers, "time" and "ax" of a table.
void take_records(Walk& walk, hid_t dataset, hid_t type, const std::string& path, std::size_t rows) {
  constexpr int most_fields = 4096;
  const int fields = std::min(H5Tget_nmembers(type), most_fields);
  for (int k = 0; k < fields; ++k) {
    const Handle field(H5Tget_member_type(type, static_cast<unsigned>(k)), H5Tclose);
    const H5T_class_t kind = field.open() ? H5Tget_class(field) : H5T_NO_CLASS;
    char* const written = H5Tget_member_name(type, static_cast<unsigned>(k));
    if (written == nullptr) continue;
    const std::string name = written;
    H5free_memory(written);
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) continue;
    const std::string whole = path + "/" + name;
    walk.signals.announce(whole, {rows});
    const Handle memory(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
    std::vector<double> values(rows);
    if (!memory.open() || H5Tinsert(memory, name.c_str(), 0, H5T_NATIVE_DOUBLE) < 0 ||
        H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      throw InputError({walk.signals.file()}, fmt::format("'{}' cannot be read; expected numbers", whole));
    walk.signals.add(whole, "", std::move(values), kind == H5T_FLOAT && H5Tget_size(field) <= 4 ? 7 : 15);
  }
}

void take_dataset(Walk& walk, hid_t dataset, const std::string& path) {
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  if (!type.open() || !space.open()) return;
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER && kind != H5T_COMPOUND && kind != H5T_STRING) return;
  if (kind == H5T_STRING) {
    if (H5Sget_simple_extent_npoints(space) == 1) require_own_storage(dataset, path, walk.signals.file());
    walk.signals.add_text(path, text_of(type, space, [&](void* to) {
                            return H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
                          }));
    return;
  }
  const Attributes stated = take_attributes(walk, dataset, path);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || rank > 2) return;
  hsize_t extent[2] = {1, 1};
  H5Sget_simple_extent_dims(space, extent, nullptr);
  if (extent[0] == 0 || extent[1] == 0) return;
  require_own_storage(dataset, path, walk.signals.file());
  if (kind == H5T_COMPOUND) {
    if (rank == 1) take_records(walk, dataset, type, path, extent[0]);
    return;
  }
  walk.signals.announce(path, {extent, extent + std::max(rank, 1)});
  std::vector<double> values(extent[0] * extent[1]);
  if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw InputError({walk.signals.file()}, fmt::format("'{}' cannot be read; expected numbers", path));
  if (stated.scale != 1.0 || stated.offset != 0.0)
    for (double& value : values) value = value * stated.scale + stated.offset;
  const std::string& unit = stated.unit;
  const int digits = kind == H5T_FLOAT && H5Tget_size(type) <= 4 ? 7 : 15;
  if (values.size() == 1)
    walk.signals.set(path, values[0]);
  else if (rank == 1 || extent[0] == 1 || extent[1] == 1)
    walk.signals.add(path, unit, std::move(values), digits);
  else  // stored row by row: a column of the file is a row of add_matrix()
    walk.signals.add_matrix(
        [&](std::size_t k, bool is_row) {
          return is_row ? fmt::format("{}[:,{}]", path, k - 1) : fmt::format("{}[{},:]", path, k - 1);
        },
        unit, values, extent[1], extent[0], digits);
}

herr_t visit(hid_t root, const char* name, const H5O_info_t* info, void* data) {
  Walk& walk = *static_cast<Walk*>(data);
  const std::string path = std::string(name) == "." ? "" : std::string("/") + name;
  constexpr std::ptrdiff_t deepest = 64;  // each object is sought by its path
  try {
    if (std::count(path.begin(), path.end(), '/') > deepest)
      throw InputError({walk.signals.file()},
                       fmt::format("groups within groups, more than {}; expected fewer", deepest));
    const Handle object(H5Oopen(root, name, H5P_DEFAULT), H5Oclose);
    if (!object.open()) return 0;
    if (info->type == H5O_TYPE_DATASET) take_dataset(walk, object, path);
    if (info->type == H5O_TYPE_GROUP) take_attributes(walk, object, path);
  } catch (...) {
    walk.failure = std::current_exception();
    return 1;
  }
  return 0;
}

class Hdf5Reader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    return beginning.starts_with("\x89HDF\r\n\x1a\n") ||
           (beginning.size() >= 520 && beginning.substr(512).starts_with("\x89HDF\r\n\x1a\n") &&
            !beginning.starts_with("MATLAB"));
  }

  RecordTable read(const std::filesystem::path& path, const RecordFormat& format) const override {
    const std::string name = path.string();
    const std::size_t size = count_bytes(path, "an HDF5 file");
    return read_apart(name, "HDF5", reading_limits(size), collect).table(format);
  }

 private:
  static void collect(CollectedSignals& signals) {
    const std::string& name = signals.file();
    const Quiet quiet;
    const Handle file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.open()) throw InputError({name}, "cannot be opened by HDF5; expected an undamaged HDF5 file");
    Walk walk{signals};
    const herr_t ended = H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &walk, H5O_INFO_BASIC);
    if (walk.failure) std::rethrow_exception(walk.failure);
    if (ended < 0)
      throw InputError({name}, "cannot be walked through by HDF5; expected an undamaged HDF5 file");
  }
};

const bool hdf5_registered = record_reader_registry().add(
    {"hdf5",
     "HDF5 and netCDF-4 files: datasets of one and two dimensions, fields of records, by their path, with "
     "units and sampling in attributes",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<Hdf5Reader>(); }});

}  // namespace
}  // namespace beamid::experiments
