# What a user of the library sees: the headers that those in include/beamid and the shipped tests reach by their
# includes. A header that none of them reaches is private and stays at home.

cmake_minimum_required(VERSION 3.25)

# public_headers(list ROOT): paths from the repository's root, as includes spell them.
function(public_headers result root)
  file(GLOB_RECURSE waiting ${root}/apps/package/include/*.hpp ${root}/tests/include/*.hpp)
  set(reached "")
  while(waiting)
    list(POP_FRONT waiting file)
    file(STRINGS ${file} includes REGEX "^#include \"[a-z]+/.*\"")
    foreach(include IN LISTS includes)
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" header "${include}")
      if(NOT header IN_LIST reached AND EXISTS ${root}/${header})
        list(APPEND reached ${header})
        list(APPEND waiting ${root}/${header})
      endif()
    endforeach()
  endwhile()
  list(SORT reached)
  set(${result} ${reached} PARENT_SCOPE)
endfunction()

# install_public_headers(ROOT DESTINATION): while installing.
function(install_public_headers root destination)
  file(INSTALL ${root}/apps/package/include/beamid ${root}/tests/include/beamid DESTINATION ${destination})
  public_headers(headers ${root})
  foreach(header IN LISTS headers)
    cmake_path(GET header PARENT_PATH folder)
    file(INSTALL ${root}/${header} DESTINATION ${destination}/beamid/${folder})
  endforeach()
endfunction()
