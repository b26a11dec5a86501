# Debian packages and a source archive: cpack -G DEB in the build folder, or ./bootstrap package.
#   beamid           the command, manual pages, completion
#   beamid-paraview  what writes meshes, by VTK
#   libbeamid-dev    headers, archives, find_package(beamid)
#   python3-beamid   the Python module
# included last by the top-level list, when all install() rules are known
set(CPACK_PACKAGE_NAME beamid)
set(CPACK_PACKAGE_VENDOR "the beamid authors")
set(CPACK_PACKAGE_CONTACT "the beamid authors <beamid@beamid.invalid>" CACHE STRING
    "Maintainer of the packages, for whoever publishes them to fill in: NAME <ADDRESS>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "identification of beams from vibration records")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_SOURCE_GENERATOR TGZ)
set(CPACK_SOURCE_PACKAGE_FILE_NAME beamid-${PROJECT_VERSION})
set(CPACK_SOURCE_IGNORE_FILES "/build/" "/results/" "/[.]git/" "/[.]cache/" "__pycache__" "compile_commands.json"
    "CMakeUserPresets.json")

set(CPACK_COMPONENTS_ALL command development paraview)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
# 1~deb12, 1~deb13, 1~ubuntu24.04: each release has libraries of its own, and an upgrade of the system replaces the package.
cmake_host_system_information(RESULT system QUERY DISTRIB_INFO)
string(REPLACE debian deb BEAMID_PACKAGE_RELEASE "1~${system_ID}${system_VERSION_ID}")
set(BEAMID_PACKAGE_CODENAME ${system_VERSION_CODENAME})
set(CPACK_DEBIAN_PACKAGE_RELEASE ${BEAMID_PACKAGE_RELEASE})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
string(CONCAT about "beamid computes beams and plane frames, and identifies stiffness, damping\n"
       "and mass from vibration records by Kalman filters, with intervals and a\nmodal analysis beside every estimate.\n\n")

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME beamid)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
# No program names what is loaded at its first use.
get_property(needed GLOBAL PROPERTY BEAMID_NEEDED_PACKAGES)
list(REMOVE_DUPLICATES needed)
list(JOIN needed ", " needed)
set(CPACK_DEBIAN_COMMAND_PACKAGE_DEPENDS ${needed})
set(recommended "gnuplot-nox | gnuplot, fonts-dejavu-core, libsndfile1, libmseed2, libfreexl1, libudunits2-0")
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS ${recommended})
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS beamid-paraview)
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "${about}This package holds the command, beamid.")

set(CPACK_DEBIAN_PARAVIEW_PACKAGE_NAME beamid-paraview)
set(CPACK_DEBIAN_PARAVIEW_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PARAVIEW_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PARAVIEW_DESCRIPTION
    "${about}With this package it writes meshes of mode shapes and motions for ParaView.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbeamid-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
string(CONCAT CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libspectra-dev, libsuitesparse-dev, "
  "libvtk9-dev, libtbb-dev, libboost-program-options-dev, zlib1g-dev, ${needed}, "
  "libtomlplusplus-dev, nlohmann-json3-dev, libfmt-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "${about}This package holds headers, static libraries and a CMake package.")

if(TARGET beamid_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-beamid)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  string(REGEX MATCH "^[0-9]+\\.[0-9]+" series "${BEAMID_PYTHON_VERSION}")  # the core is made for one series
  string(REPLACE "." ";" next ${series})
  list(POP_FRONT next major minor)
  math(EXPR minor "${minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${series}), python3 (<< ${major}.${minor}), python3-numpy, ${needed}")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS ${recommended})
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib, beamid-paraview")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "${about}This package holds the Python module, beamid.")
endif()

# What Debian expects beside the files: the license, both changelogs, compressed manual pages.
find_program(GZIP gzip)
find_program(DPKG_DEB dpkg-deb)
if(GZIP AND DPKG_DEB)
  string(TIMESTAMP BEAMID_PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
  set(documents ${PROJECT_BINARY_DIR}/debian)
  foreach(pair beamid=command beamid-paraview=paraview libbeamid-dev=development python3-beamid=python)
    string(REPLACE "=" ";" pair ${pair})
    list(GET pair 0 BEAMID_PACKAGE)
    list(GET pair 1 component)
    configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in ${documents}/${BEAMID_PACKAGE}/changelog.Debian @ONLY)
    configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/copyright ${documents}/${BEAMID_PACKAGE}/copyright COPYONLY)
    configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${documents}/${BEAMID_PACKAGE}/changelog COPYONLY)
    execute_process(COMMAND ${GZIP} -9nf changelog.Debian changelog WORKING_DIRECTORY ${documents}/${BEAMID_PACKAGE})
    install(DIRECTORY ${documents}/${BEAMID_PACKAGE} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc COMPONENT ${component}
            EXCLUDE_FROM_ALL)
  endforeach()
  install(CODE "file(GLOB pages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/man/man1/beamid*.1\")
    execute_process(COMMAND ${GZIP} -9nf \${pages})" COMPONENT command)
endif()

include(CPack)
