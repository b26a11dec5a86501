# Debian ships SuiteSparse without a CMake package: this finds the part beamid uses.
#   SuiteSparse::UMFPACK  sparse LU of unsymmetric and indefinite matrices
find_path(SUITESPARSE_INCLUDE_DIR umfpack.h PATH_SUFFIXES suitesparse)
find_library(UMFPACK_LIBRARY umfpack)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS UMFPACK_LIBRARY SUITESPARSE_INCLUDE_DIR)
mark_as_advanced(SUITESPARSE_INCLUDE_DIR UMFPACK_LIBRARY)

if(SuiteSparse_FOUND AND NOT TARGET SuiteSparse::UMFPACK)
  add_library(SuiteSparse::UMFPACK UNKNOWN IMPORTED)
  set_target_properties(SuiteSparse::UMFPACK PROPERTIES
    IMPORTED_LOCATION ${UMFPACK_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${SUITESPARSE_INCLUDE_DIR})
endif()
