// The functions of HDF5, loaded when one is first called, its identifiers and messages, kept in order, and
// whether a file holds its numbers itself.
#pragma once

#include <hdf5.h>

#include <string>

#include <needed_library.hpp>

namespace beamid::experiments {

inline constexpr NeededLibrary hdf5{BEAMID_HDF5};
BEAMID_NEEDED(hdf5, H5check_version);
BEAMID_NEEDED(hdf5, H5open);
BEAMID_NEEDED(hdf5, H5free_memory);
BEAMID_NEEDED(hdf5, H5Eget_auto2);
BEAMID_NEEDED(hdf5, H5Eset_auto2);
BEAMID_NEEDED(hdf5, H5Fopen);
BEAMID_NEEDED(hdf5, H5Fcreate);
BEAMID_NEEDED(hdf5, H5Fclose);
BEAMID_NEEDED(hdf5, H5Oopen);
BEAMID_NEEDED(hdf5, H5Oclose);
BEAMID_NEEDED(hdf5, H5Ovisit2);
BEAMID_NEEDED(hdf5, H5Lvisit);
BEAMID_NEEDED(hdf5, H5Gcreate2);
BEAMID_NEEDED(hdf5, H5Gclose);
BEAMID_NEEDED(hdf5, H5Aopen);
BEAMID_NEEDED(hdf5, H5Aopen_by_idx);
BEAMID_NEEDED(hdf5, H5Aget_name);
BEAMID_NEEDED(hdf5, H5Acreate2);
BEAMID_NEEDED(hdf5, H5Aclose);
BEAMID_NEEDED(hdf5, H5Aexists);
BEAMID_NEEDED(hdf5, H5Aget_space);
BEAMID_NEEDED(hdf5, H5Aget_type);
BEAMID_NEEDED(hdf5, H5Aread);
BEAMID_NEEDED(hdf5, H5Awrite);
BEAMID_NEEDED(hdf5, H5Dcreate2);
BEAMID_NEEDED(hdf5, H5Dclose);
BEAMID_NEEDED(hdf5, H5Dget_create_plist);
BEAMID_NEEDED(hdf5, H5Dget_space);
BEAMID_NEEDED(hdf5, H5Dget_type);
BEAMID_NEEDED(hdf5, H5Dread);
BEAMID_NEEDED(hdf5, H5Dwrite);
BEAMID_NEEDED(hdf5, H5Pcreate);
BEAMID_NEEDED(hdf5, H5Pclose);
BEAMID_NEEDED(hdf5, H5Pget_external_count);
BEAMID_NEEDED(hdf5, H5Pget_layout);
BEAMID_NEEDED(hdf5, H5Pset_obj_track_times);
BEAMID_NEEDED(hdf5, H5Rcreate);
BEAMID_NEEDED(hdf5, H5Screate);
BEAMID_NEEDED(hdf5, H5Screate_simple);
BEAMID_NEEDED(hdf5, H5Sclose);
BEAMID_NEEDED(hdf5, H5Sget_simple_extent_dims);
BEAMID_NEEDED(hdf5, H5Sget_simple_extent_ndims);
BEAMID_NEEDED(hdf5, H5Sget_simple_extent_npoints);
BEAMID_NEEDED(hdf5, H5Tcopy);
BEAMID_NEEDED(hdf5, H5Tcreate);
BEAMID_NEEDED(hdf5, H5Tclose);
BEAMID_NEEDED(hdf5, H5Tget_class);
BEAMID_NEEDED(hdf5, H5Tget_member_name);
BEAMID_NEEDED(hdf5, H5Tget_member_type);
BEAMID_NEEDED(hdf5, H5Tget_nmembers);
BEAMID_NEEDED(hdf5, H5Tget_size);
BEAMID_NEEDED(hdf5, H5Tinsert);
BEAMID_NEEDED(hdf5, H5Tis_variable_str);
BEAMID_NEEDED(hdf5, H5Tset_size);
BEAMID_NEEDED(hdf5, H5Tset_strpad);
BEAMID_NEEDED(hdf5, H5Tvlen_create);

// What its macros stand for: H5T_NATIVE_DOUBLE is (H5open(), H5T_NATIVE_DOUBLE_g).
BEAMID_NEEDED_VARIABLE(hdf5, H5P_CLS_DATASET_CREATE_ID_g);
BEAMID_NEEDED_VARIABLE(hdf5, H5T_C_S1_g);
BEAMID_NEEDED_VARIABLE(hdf5, H5T_IEEE_F64LE_g);
BEAMID_NEEDED_VARIABLE(hdf5, H5T_NATIVE_DOUBLE_g);
BEAMID_NEEDED_VARIABLE(hdf5, H5T_NATIVE_INT64_g);
BEAMID_NEEDED_VARIABLE(hdf5, H5T_STD_I64LE_g);
BEAMID_NEEDED_VARIABLE(hdf5, H5T_STD_REF_OBJ_g);

/// An HDF5 identifier that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  bool open() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Silences HDF5, which would print its whole stack of errors.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Refuses a dataset that takes its numbers from another file: by external storage, or as a virtual dataset.
/// A record that somebody sends must not be able to show any file that its reader may read.
/// @throws InputError
void require_own_storage(hid_t dataset, const std::string& path, const std::string& file);

/// The same for all datasets of a file, for libraries that open it by themselves; links to other files are
/// refused, too. @throws InputError, also where HDF5 cannot walk through the file.
void require_own_storage(const std::string& file);

}  // namespace beamid::experiments
