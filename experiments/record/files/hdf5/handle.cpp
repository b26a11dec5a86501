#include "experiments/record/files/hdf5/handle.hpp"

#include <fmt/format.h>

#include <optional>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {
namespace {

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

}  // namespace beamid::experiments
