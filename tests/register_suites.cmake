# Writes the list of tests that ctest reads, one for each suite of a test program: cmake -D PROGRAM=... -D PREFIX=fem.
# -D LIST=... -D SOURCES=... [-D TOGETHER=...] [-D EMULATOR=...] -P ... A process for every single test would take a third of the time of
# all of them for its start, and repeat what the tests of a suite share. Suites below SOURCES/TOGETHER, a folder or the
# beginning of a file's path, share what takes long to find: all of them are one.
execute_process(COMMAND ${EMULATOR} ${PROGRAM} --gtest_list_tests --gtest_output=json:${LIST}.json
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(READ ${LIST}.json listed)
string(REPLACE "\\/" "/" listed "${listed}")
set(written "")
function(add name filter)
  # Skipped where every test of it was: nothing passed, and nothing but skipped tests is listed after that.
  string(APPEND written "add_test([=[${PREFIX}${name}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${filter}]=])\n"
         "set_tests_properties([=[${PREFIX}${name}]=] PROPERTIES SKIP_REGULAR_EXPRESSION "
         "[=[PASSED  . 0 tests\\.\n(.  SKIPPED [^\n]*\n)+$]=])\n")
  set(written "${written}" PARENT_SCOPE)
endfunction()

set(together "")
# A suite is the name that a number of tests follows; its place is that of its first test.
string(REGEX MATCHALL "\"name\": \"[^\"]*\",\n *\"tests\"|\"file\": \"[^\"]*\"" lines "${listed}")
foreach(line IN LISTS lines)
  if(line MATCHES "\"name\": \"([^\"]*)\"")
    set(suite "${CMAKE_MATCH_1}")
    continue()
  elseif(NOT suite OR NOT line MATCHES "\"file\": \"([^\"]*)\"")
    continue()
  endif()
  string(FIND "${CMAKE_MATCH_1}" "${SOURCES}/${TOGETHER}" found)
  if(TOGETHER AND found EQUAL 0)
    list(APPEND together "${suite}.*")
  else()
    add("${suite}" "${suite}.*")
  endif()
  set(suite "")
endforeach()
if(together)
  string(REPLACE ";" ":" together "${together}")
  add(${TOGETHER} "${together}")
endif()
file(WRITE ${LIST} "${written}")
