# Debian ships SuiteSparse without a CMake package: this finds the parts beamid uses.
#   SuiteSparse::UMFPACK  sparse LU of unsymmetric and indefinite matrices
#   SuiteSparse::CHOLMOD  sparse Cholesky of positive definite ones
find_path(SUITESPARSE_INCLUDE_DIR umfpack.h PATH_SUFFIXES suitesparse)
find_library(UMFPACK_LIBRARY umfpack)
find_library(CHOLMOD_LIBRARY cholmod)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS UMFPACK_LIBRARY CHOLMOD_LIBRARY SUITESPARSE_INCLUDE_DIR)
mark_as_advanced(SUITESPARSE_INCLUDE_DIR UMFPACK_LIBRARY CHOLMOD_LIBRARY)

if(SuiteSparse_FOUND AND NOT TARGET SuiteSparse::UMFPACK)
  foreach(part UMFPACK CHOLMOD)
    add_library(SuiteSparse::${part} UNKNOWN IMPORTED)
    set_target_properties(SuiteSparse::${part} PROPERTIES
      IMPORTED_LOCATION ${${part}_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${SUITESPARSE_INCLUDE_DIR})
  endforeach()
endif()
