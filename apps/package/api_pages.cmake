# Pages of the library's interface by Doxygen, from the headers that are installed: cmake -D ROOT=... -D BUILD=...
# -D DOXYGEN=... -D VERSION=... -P ... A warning is an error: what a comment says of a parameter must fit.
include(${CMAKE_CURRENT_LIST_DIR}/public_headers.cmake)
public_headers(headers ${ROOT})
list(TRANSFORM headers PREPEND ${ROOT}/)
file(GLOB own ${ROOT}/apps/package/include/beamid/*.hpp ${ROOT}/tests/include/beamid/testing/*.hpp)
file(GLOB pages ${ROOT}/docs/library.md ${ROOT}/docs/references.md ${ROOT}/docs/tutorials/*_of_your_own/README.md)
list(JOIN pages " " pages)
list(JOIN headers " " headers)
list(JOIN own " " own)

file(MAKE_DIRECTORY ${BUILD}/docs)
file(WRITE ${BUILD}/docs/Doxyfile "PROJECT_NAME = beamid
PROJECT_NUMBER = ${VERSION}
PROJECT_BRIEF = \"Beams, their reduction, and what vibration records tell of them\"
INPUT = ${pages} ${own} ${headers}
USE_MDFILE_AS_MAINPAGE = ${ROOT}/docs/library.md
OUTPUT_DIRECTORY = ${BUILD}/docs
STRIP_FROM_PATH = ${ROOT}/apps/package/include ${ROOT}/tests/include ${ROOT}
STRIP_FROM_INC_PATH = ${ROOT}/apps/package/include ${ROOT}/tests/include ${ROOT}
INCLUDE_PATH = ${ROOT} ${ROOT}/apps/package/include ${ROOT}/tests/include
FULL_PATH_NAMES = YES
EXTRACT_ALL = YES
WARN_IF_INCOMPLETE_DOC = NO
HIDE_UNDOC_RELATIONS = YES
JAVADOC_AUTOBRIEF = YES
BUILTIN_STL_SUPPORT = YES
SORT_MEMBER_DOCS = NO
GENERATE_LATEX = NO
HAVE_DOT = NO
TOC_INCLUDE_HEADINGS = 2
MACRO_EXPANSION = YES
QUIET = YES
WARN_AS_ERROR = FAIL_ON_WARNINGS
WARN_LOGFILE = ${BUILD}/docs/warnings.txt
")
file(REMOVE_RECURSE ${BUILD}/docs/html)
execute_process(COMMAND ${DOXYGEN} ${BUILD}/docs/Doxyfile RESULT_VARIABLE code)
file(READ ${BUILD}/docs/warnings.txt warnings)
if(warnings OR NOT code EQUAL 0)
  message(FATAL_ERROR "doxygen: exit code ${code}\n${warnings}")
endif()
