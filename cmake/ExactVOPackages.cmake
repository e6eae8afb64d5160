# SPDX-License-Identifier: GPL-3.0-or-later
# Debian packages: `cpack -G DEB` in the build folder makes exactvo, libexactvo-dev and, where they are built, exactvo-verify
# and python3-exactvo (scripts/make_packages.sh). With the prefix /usr libraries lie where Debian wants them, lib/<architecture>.
set(CPACK_PACKAGE_NAME exactvo)
set(CPACK_PACKAGE_VENDOR "ExactVO")
set(CPACK_PACKAGE_CONTACT "The ExactVO maintainers <maintainers@exactvo.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "velocity obstacles with exact geometry and certificates")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_COMPONENTS_ALL runtime dev)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME exactvo)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS gnuplot-nox)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "The program exactvo, its scenarios and its guide.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libexactvo-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
# What the installed CMake package looks for (ExactVOConfig.cmake), component by component.
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libgmp-dev, libmpfr-dev, libtbb-dev${EXACTVO_HIGHWAY_PACKAGE}")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS
  "libgdal-dev, libsqlite3-dev, libopenmpi-dev, libpugixml-dev, libyaml-cpp-dev, libssl-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION "Static libraries and headers; find_package(ExactVO) and pkg-config find them.")

# The proven checker alone: what others computed is checked without the program and its libraries.
if(TARGET exactvo_verify)
  list(APPEND CPACK_COMPONENTS_ALL verify)
  set(CPACK_DEBIAN_VERIFY_PACKAGE_NAME exactvo-verify)
  set(CPACK_DEBIAN_VERIFY_PACKAGE_SHLIBDEPS ON)
  set(CPACK_COMPONENT_VERIFY_DESCRIPTION "The checker exactvo-verify, which is proven in Coq.")
  # The guide and the README call it beside exactvo, and it is small.
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS exactvo-verify)
endif()

if(EXACTVO_BUILDS_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-exactvo)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  # GDAL's module is the program's.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "exactvo (= ${PROJECT_VERSION}), python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-pandas, python3-shapely")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python package exactvo.")
endif()

# What Debian's policy wants in every package: its licence and its changes.
find_program(EXACTVO_GZIP gzip)
if(EXACTVO_GZIP)
  set(changes ${PROJECT_BINARY_DIR}/debian/changelog)
  file(WRITE ${changes} "exactvo (${PROJECT_VERSION}) stable; urgency=medium

  * See /usr/share/doc/ExactVO/CHANGELOG.md in the package exactvo.

 -- ${CPACK_PACKAGE_CONTACT}  Thu, 01 Jan 2026 00:00:00 +0000
")
  execute_process(COMMAND ${EXACTVO_GZIP} --best --no-name --force ${changes})
  foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    string(TOUPPER ${component} upper)
    set(folder ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian_copyright RENAME copyright DESTINATION ${folder} COMPONENT ${component})
    install(FILES ${changes}.gz DESTINATION ${folder} COMPONENT ${component})
  endforeach()
  # And compressed manual pages, of which only these two components have any.
  foreach(component runtime verify)
    install(CODE "file(GLOB pages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1/exactvo*.1\")
      if(pages)
        execute_process(COMMAND ${EXACTVO_GZIP} --best --no-name --force \${pages} COMMAND_ERROR_IS_FATAL ANY)
      endif()" COMPONENT ${component})
  endforeach()
endif()
include(CPack)
