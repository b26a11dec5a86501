# SUNDIALS 6 (Debian 12) or 7 (Debian 13). CVODES and not CVODE: both define the same functions, and filters/ needs
# the sensitivities of the former.
find_package(SUNDIALS 6.4 REQUIRED COMPONENTS cvodes arkode nvecserial sunmatrixsparse sunlinsolklu)

# beamid_link_sundials(TARGET PART...): with MPI where SUNDIALS was built with it, as Debian's 7 is. Its headers include
# mpi.h then, which its own targets do not say.
function(beamid_link_sundials target)
  list(TRANSFORM ARGN PREPEND SUNDIALS:: OUTPUT_VARIABLE parts)
  target_link_libraries(${target} PRIVATE ${parts})
  if(TARGET MPI::MPI_C)  # SUNDIALS looks for it; nothing before it does
    find_package(MPI REQUIRED COMPONENTS C)
    target_include_directories(${target} SYSTEM PRIVATE ${MPI_C_INCLUDE_DIRS})
    target_compile_definitions(${target} PRIVATE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
    target_link_libraries(${target} PRIVATE ${MPI_C_LIBRARIES})
  endif()
endfunction()
