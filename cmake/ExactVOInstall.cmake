# SPDX-License-Identifier: GPL-3.0-or-later
include(CMakePackageConfigHelpers)
get_property(modules GLOBAL PROPERTY EXACTVO_MODULES)
install(TARGETS ${modules} EXPORT ExactVOTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT ExactVOTargets NAMESPACE exactvo:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ExactVO)
configure_package_config_file(cmake/ExactVOConfig.cmake.in ExactVOConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ExactVO)
write_basic_package_version_file(ExactVOConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ExactVOConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ExactVOConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ExactVO)
