// Does an HDF5 file hold its numbers itself?
#pragma once

#include <hdf5.h>

#include <string>

namespace beamid::experiments {

/// Refuses a dataset that takes its numbers from another file: by external storage, or as a virtual dataset.
/// A record that somebody sends must not be able to show any file that its reader may read.
/// @throws InputError
void require_own_storage(hid_t dataset, const std::string& path, const std::string& file);

/// The same for all datasets of a file, for libraries that open it by themselves; links to other files are
/// refused, too. @throws InputError, also where HDF5 cannot walk through the file.
void require_own_storage(const std::string& file);

}  // namespace beamid::experiments
