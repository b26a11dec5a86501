# Every header of an installation compiles by itself:
# cmake -D PACKAGE=PREFIX -D WORK=... -D COMPILER=... -P ... Units of unchanged headers are kept from run to run.
execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${CMAKE_CURRENT_LIST_DIR}/headers -B ${WORK}
                -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_PREFIX_PATH=${PACKAGE} -D INCLUDE=${PACKAGE}/include
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK} COMMAND_ERROR_IS_FATAL ANY)
