# Installs the project and asks the installed command for its version: cmake -D BUILD=... -D PREFIX=... -P ...
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${PREFIX}/bin/beamid --version COMMAND_ERROR_IS_FATAL ANY)
