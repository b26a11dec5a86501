# Configures, builds and runs a project of a tutorial as its reader does, against an installation or a build
# folder: cmake -D PROJECT=... -D PACKAGE=... -D WORK=... -D COMPILER=... [-D INSTALL_FROM=...] -P ...
# Then every line of the project's expected.txt, COMMAND => PART OF WHAT IT PRINTS, must hold.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: exit code ${code}\n${out}")
  endif()
  set(printed "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
if(INSTALL_FROM)
  set(PACKAGE ${WORK}/prefix)
  run(${CMAKE_COMMAND} --install ${INSTALL_FROM} --prefix ${PACKAGE})
  run(${PACKAGE}/bin/beamid --version)
endif()
run(${CMAKE_COMMAND} -G Ninja -S ${PROJECT} -B ${WORK}/build -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_PREFIX_PATH=${PACKAGE})
run(${CMAKE_COMMAND} --build ${WORK}/build)

file(STRINGS ${PROJECT}/expected.txt expectations)
foreach(expectation IN LISTS expectations)
  if(NOT expectation MATCHES "^mybeamid (.*) => (.*)$")
    continue()  # a remark
  endif()
  set(words "${CMAKE_MATCH_1}")
  string(REPLACE "\\n" "\n" part "${CMAKE_MATCH_2}")
  separate_arguments(words UNIX_COMMAND "${words}")
  run(${CMAKE_COMMAND} -E chdir ${PROJECT} ${WORK}/build/mybeamid ${words})
  if(NOT printed MATCHES "${part}")
    message(FATAL_ERROR "mybeamid ${words}: expected '${part}' in\n${printed}")
  endif()
endforeach()
file(REMOVE_RECURSE ${WORK})
