# SUNDIALS 6 (Debian 12) or 7 (Debian 13). CVODES and not CVODE: both define the same functions, and filters/ needs
# the sensitivities of the former.
find_package(SUNDIALS 6.4 REQUIRED COMPONENTS cvodes arkode nvecserial sunmatrixsparse sunlinsolklu)

# beamid_use_sundials(TARGET): its headers, and its libraries at their first use (sundials_functions.hpp). Where SUNDIALS was built with MPI, as
# Debian's 7 is, its headers include mpi.h, which its own targets do not say.
function(beamid_use_sundials target)
  target_include_directories(${target} SYSTEM PRIVATE
                             $<TARGET_PROPERTY:SUNDIALS::sunlinsolklu_shared,INTERFACE_INCLUDE_DIRECTORIES>)
  foreach(part cvodes arkode sunlinsolklu)
    string(TOUPPER ${part} name)
    beamid_needed(${target} ${name} SUNDIALS::${part}_shared)
  endforeach()
  if(TARGET MPI::MPI_C)  # SUNDIALS looks for it; nothing before it does
    find_package(MPI REQUIRED COMPONENTS C)
    target_include_directories(${target} SYSTEM PRIVATE ${MPI_C_INCLUDE_DIRS})
    target_compile_definitions(${target} PRIVATE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
  endif()
endfunction()
