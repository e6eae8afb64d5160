# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` puts where: libraries and headers for find_package(ExactVO), the program, its data and schemas.
include(CMakePackageConfigHelpers)
get_property(modules GLOBAL PROPERTY EXACTVO_MODULES)
set(EXACTVO_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ExactVO)

# A static library drags its private ones to the consumer's link line. The package looks for those that the modules
# really link, so that a consumer needs no more than that.
function(exactvo_package_dependencies out)
  set(linked "")
  foreach(module ${modules})
    get_target_property(libraries ${module} LINK_LIBRARIES)
    string(APPEND linked ";${libraries}")
  endforeach()
  set(text "")
  foreach(dependency
      "Boost::|Boost" "Eigen3::|Eigen3 CONFIG" "TBB::|TBB CONFIG" "hwy::|HWY CONFIG" "CGAL::|CGAL"
      "nlohmann_json::|nlohmann_json CONFIG" "fmt::|fmt CONFIG" "OpenSSL::|OpenSSL" "GDAL::|GDAL" "SQLite::|SQLite3" "MPI::|MPI COMPONENTS CXX"
      "yaml-cpp|yaml-cpp CONFIG" "pugixml|pugixml CONFIG" "Threads::|Threads")
    string(REPLACE "|" ";" pair "${dependency}")
    list(GET pair 0 prefix)
    list(GET pair 1 package)
    if(linked MATCHES "(^|;)${prefix}")
      string(APPEND text "find_dependency(${package})\n")
    endif()
  endforeach()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()
exactvo_package_dependencies(EXACTVO_PACKAGE_DEPENDENCIES)

install(TARGETS ${modules} EXPORT ExactVOTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT ExactVOTargets NAMESPACE exactvo:: DESTINATION ${EXACTVO_PACKAGE_DIR})
configure_package_config_file(cmake/ExactVOConfig.cmake.in ExactVOConfig.cmake
  INSTALL_DESTINATION ${EXACTVO_PACKAGE_DIR})
write_basic_package_version_file(ExactVOConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ExactVOConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ExactVOConfigVersion.cmake
  DESTINATION ${EXACTVO_PACKAGE_DIR})

if(TARGET exactvo)
  install(TARGETS exactvo RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY datasets/data datasets/schema DESTINATION ${CMAKE_INSTALL_DATADIR}/exactvo)
endif()
# The README's links hold where it is installed as well.
install(FILES LICENSE README.md CITATION.cff CHANGELOG.md HACKING.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/guide docs/images docs/adr docs/design DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY datasets/data datasets/schema DESTINATION ${CMAKE_INSTALL_DOCDIR}/datasets)
