# Writes the list of tests that ctest reads, one for each suite of a test program: cmake -D PROGRAM=...
# -D PREFIX=fem. -D LIST=... -P ... A process for every single test would take a third of the time of all of them
# for its start, and repeat what the tests of a suite share.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" lines "${listed}")
set(written "")
foreach(line IN LISTS lines)
  if(NOT line MATCHES "^([^ ]+)\\.( |$)")
    continue()  # a test of the suite above
  endif()
  set(suite "${CMAKE_MATCH_1}")
  # Skipped where every test of it was: nothing passed, and nothing but skipped tests is listed after that.
  string(APPEND written "add_test([=[${PREFIX}${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
         "set_tests_properties([=[${PREFIX}${suite}]=] PROPERTIES SKIP_REGULAR_EXPRESSION "
         "[=[PASSED  . 0 tests\\.\n(.  SKIPPED [^\n]*\n)+$]=])\n")
endforeach()
file(WRITE ${LIST} "${written}")
