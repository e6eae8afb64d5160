# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` puts where: libraries and headers for find_package(ExactVO), the program, its data and schemas.
include(CMakePackageConfigHelpers)
set(EXACTVO_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ExactVO)

# exactvo_needs_of(<component> <out>): a static library drags its private ones to the consumer's link line. The package
# looks for those that the component really links, so that a consumer needs no more than that. (Of libraries that are
# headers alone nothing is left: they are linked in $<BUILD_INTERFACE:...>.)
function(exactvo_needs_of component out)
  get_target_property(linked exactvo_${component} LINK_LIBRARIES)
  get_property(parts GLOBAL PROPERTY EXACTVO_PARTS_OF_${component})
  foreach(part IN LISTS parts)
    get_target_property(libraries exactvo_${component}_${part} LINK_LIBRARIES)
    list(APPEND linked ${libraries})
  endforeach()
  set(text "")
  foreach(dependency
      "TBB::|libtbb-dev TBB CONFIG" "hwy::|libhwy-dev HWY CONFIG" "GDAL::|libgdal-dev GDAL"
      "SQLite::|libsqlite3-dev SQLite3" "MPI::|libopenmpi-dev MPI COMPONENTS CXX"
      "yaml-cpp|libyaml-cpp-dev yaml-cpp CONFIG" "pugixml|libpugixml-dev pugixml CONFIG" "OpenSSL::|libssl-dev OpenSSL")
    string(REPLACE "|" ";" pair "${dependency}")
    list(GET pair 0 prefix)
    list(GET pair 1 arguments)
    if(linked MATCHES "(^|;)${prefix}")
      string(APPEND text "  _exactvo_need(${component} ${arguments})\n")
    endif()
  endforeach()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

set(EXACTVO_NEEDS "")
foreach(component IN LISTS EXACTVO_BUILT_COMPONENTS)
  exactvo_needs_of(${component} needs)
  string(APPEND EXACTVO_NEEDS "${needs}")
  # A file each, so that a consumer of one component meets no target of another one's libraries.
  install(EXPORT ExactVO-${component} FILE ExactVO-${component}.cmake NAMESPACE exactvo::
    DESTINATION ${EXACTVO_PACKAGE_DIR} COMPONENT dev)
endforeach()
string(REGEX REPLACE "\n$" "" EXACTVO_NEEDS "${EXACTVO_NEEDS}")
configure_package_config_file(cmake/ExactVOConfig.cmake.in ExactVOConfig.cmake
  INSTALL_DESTINATION ${EXACTVO_PACKAGE_DIR})
write_basic_package_version_file(ExactVOConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ExactVOConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ExactVOConfigVersion.cmake
  DESTINATION ${EXACTVO_PACKAGE_DIR} COMPONENT dev)

# For builds without CMake: `pkg-config --cflags --libs exactvo` is the component formation with those before it.
if("formation" IN_LIST EXACTVO_BUILT_COMPONENTS)
  file(RELATIVE_PATH EXACTVO_PREFIX_SEEN_FROM_PC ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  string(REGEX REPLACE "/$" "" EXACTVO_PREFIX_SEEN_FROM_PC "${EXACTVO_PREFIX_SEEN_FROM_PC}")
  configure_file(cmake/exactvo.pc.in exactvo.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/exactvo.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endif()

if(TARGET exactvo)
  install(TARGETS exactvo RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  install(DIRECTORY datasets/data datasets/schema DESTINATION ${CMAKE_INSTALL_DATADIR}/exactvo COMPONENT runtime)
  set(pages ${PROJECT_BINARY_DIR}/help_pages)
  install(DIRECTORY ${pages}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime OPTIONAL
    PATTERN exactvo-verify.1 EXCLUDE)
  install(FILES ${pages}/completions/exactvo.bash RENAME exactvo
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT runtime OPTIONAL)
  # Debian's zsh looks below /usr in the folder for packages alone, below /usr/local in that of zsh.
  set(zsh_folder site-functions)
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /etc/debian_version)
    set(zsh_folder vendor-completions)
  endif()
  install(FILES ${pages}/completions/_exactvo
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${zsh_folder} COMPONENT runtime OPTIONAL)
endif()
if(TARGET exactvo_verify)
  install(PROGRAMS ${PROJECT_BINARY_DIR}/bin/exactvo-verify DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT verify)
  # CMake strips what it linked itself, and this is OCaml's.
  install(CODE "if(CMAKE_INSTALL_DO_STRIP)
      execute_process(COMMAND ${CMAKE_STRIP} \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/exactvo-verify\" COMMAND_ERROR_IS_FATAL ANY)
    endif()" COMPONENT verify)
  install(FILES ${PROJECT_BINARY_DIR}/help_pages/man/exactvo-verify.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT verify OPTIONAL)
endif()
# The README's links hold where it is installed as well.
install(FILES LICENSE README.md CITATION.cff CHANGELOG.md CONTRIBUTING.md HACKING.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT runtime)
install(FILES docs/building.md docs/claims.md docs/stability.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT runtime)
install(DIRECTORY docs/guide docs/images docs/adr docs/design docs/measurements DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT runtime)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
install(DIRECTORY datasets/data datasets/schema DESTINATION ${CMAKE_INSTALL_DOCDIR}/datasets COMPONENT runtime)

include(ExactVOPackages)
