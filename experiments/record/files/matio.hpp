// The functions of matio, loaded when a MATLAB file is read, and its objects that free themselves.
#pragma once

#include <matio.h>

#include <needed_library.hpp>

namespace beamid::experiments {

inline constexpr NeededLibrary matio{BEAMID_MATIO};
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

}  // namespace beamid::experiments
