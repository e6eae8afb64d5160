# SPDX-License-Identifier: GPL-3.0-or-later
# One way to declare a module, a test, a refusal of arguments, a benchmark and an example.
include(GNUInstallDirs)
include(GoogleTest)

# exactvo_add_module(<name> [STATIC] SOURCES ... [CGAL_SOURCES ...] [PUBLIC targets...] [PRIVATE targets...])
# The library exactvo::<name>, headers under <name>/include. CGAL_SOURCES are compiled with CGAL's own flags
# (-frounding-math), which the plain and vectorised sources must not get: they are objects of a target of their own,
# exactvo_<name>_cgal.
function(exactvo_add_module name)
  cmake_parse_arguments(arg "STATIC" "" "SOURCES;CGAL_SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target exactvo_${name})
  set(type "")
  if(arg_STATIC)
    set(type STATIC)
  endif()
  add_library(${target} ${type} ${arg_SOURCES})
  add_library(exactvo::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:exactvo_build_flags>)
  # CGAL's warnings print to stderr; ours are errors and answers.
  target_compile_definitions(${target} PRIVATE CGAL_NO_WARNINGS)
  if(arg_CGAL_SOURCES)
    add_library(${target}_cgal OBJECT ${arg_CGAL_SOURCES})
    set_target_properties(${target}_cgal PROPERTIES POSITION_INDEPENDENT_CODE ON UNITY_BUILD_MODE GROUP)
    target_include_directories(${target}_cgal
      PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/include ${CMAKE_CURRENT_SOURCE_DIR}/src)
    target_compile_definitions(${target}_cgal PRIVATE CGAL_NO_WARNINGS)
    target_link_libraries(${target}_cgal PRIVATE ${arg_PUBLIC} ${arg_PRIVATE} exactvo_build_flags)
    target_compile_options(${target}_cgal PRIVATE -frounding-math -Wno-conversion -Wno-shadow)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_cgal>)
  endif()
  install(TARGETS ${target} EXPORT ExactVO-${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
endfunction()

# exactvo_add_part(<module> <name> SOURCES ... [PRIVATE targets...])
# What only a library behind <module>'s own needs: a static library that is linked with the module, but for programs with
# the property EXACTVO_LOADS_PARTS.
function(exactvo_add_part module name)
  cmake_parse_arguments(arg "" "" "SOURCES;PRIVATE" ${ARGN})
  set(target exactvo_${module}_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${module}_${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE exactvo_${module} ${arg_PRIVATE} $<BUILD_INTERFACE:exactvo_build_flags>)
  target_link_libraries(exactvo_${module}
    INTERFACE $<$<NOT:$<BOOL:$<TARGET_PROPERTY:EXACTVO_LOADS_PARTS>>>:$<TARGET_NAME:${target}>>)
  set_property(GLOBAL APPEND PROPERTY EXACTVO_PARTS_OF_${module} ${name})
  install(TARGETS ${target} EXPORT ExactVO-${module} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
endfunction()

# exactvo_add_test(<name> SOURCES ... [LIBS ...] [LABELS ...] [TIMEOUT s])
function(exactvo_add_test name)
  cmake_parse_arguments(arg "" "TIMEOUT" "SOURCES;LIBS;LABELS" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  if(EXACTVO_SANITIZE)
    math(EXPR arg_TIMEOUT "5 * ${arg_TIMEOUT}")  # instrumented code takes two to ten times as long
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBS} exactvo_test_support GTest::gtest GTest::gmock GTest::gtest_main exactvo_build_flags)
  target_compile_definitions(${name} PRIVATE EXACTVO_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT})
endfunction()

# exactvo_add_refusal(<test> <words> <program> <argument>...): the program refuses its arguments, by its name and in
# these words (a regular expression).
function(exactvo_add_refusal name words program)
  add_test(NAME ${name} COMMAND ${program} ${ARGN})
  set_tests_properties(${name} PROPERTIES LABELS unit PASS_REGULAR_EXPRESSION "^${program}: error: ${words}")
endfunction()

# exactvo_add_bench(<name> SOURCES ... [LIBS ...])
function(exactvo_add_bench name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBS} benchmark::benchmark exactvo_build_flags)
endfunction()
