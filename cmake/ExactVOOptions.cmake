# SPDX-License-Identifier: GPL-3.0-or-later
# What can be switched, and the flags that every target of the project shares.

# Each component uses those before it, so that the last one named decides.
set(EXACTVO_ALL_COMPONENTS geometry vo formation datasets)
set(EXACTVO_COMPONENTS "${EXACTVO_ALL_COMPONENTS}" CACHE STRING
  "Libraries to build, with those they use: ${EXACTVO_ALL_COMPONENTS}")
set(EXACTVO_BUILT_COMPONENTS "")
foreach(component IN LISTS EXACTVO_COMPONENTS)
  list(FIND EXACTVO_ALL_COMPONENTS "${component}" place)
  if(place EQUAL -1)
    list(JOIN EXACTVO_ALL_COMPONENTS ", " known)
    message(FATAL_ERROR "EXACTVO_COMPONENTS names '${component}'; expected some of ${known}.")
  endif()
  math(EXPR count "${place} + 1")
  list(LENGTH EXACTVO_BUILT_COMPONENTS built)
  if(count GREATER built)
    list(SUBLIST EXACTVO_ALL_COMPONENTS 0 ${count} EXACTVO_BUILT_COMPONENTS)
  endif()
endforeach()
if(NOT EXACTVO_BUILT_COMPONENTS)
  message(FATAL_ERROR "EXACTVO_COMPONENTS is empty; expected some of ${EXACTVO_ALL_COMPONENTS}.")
endif()
set(EXACTVO_BUILDS_DATASETS OFF)
if("datasets" IN_LIST EXACTVO_BUILT_COMPONENTS)
  set(EXACTVO_BUILDS_DATASETS ON)
endif()

option(EXACTVO_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(EXACTVO_BENCH "Build the benchmarks" ${PROJECT_IS_TOP_LEVEL})
option(EXACTVO_EXAMPLES "Build the examples" ${PROJECT_IS_TOP_LEVEL})
option(EXACTVO_WERROR "Treat warnings as errors" OFF)
if(EXACTVO_BUILDS_DATASETS)
  option(EXACTVO_TOOLS "Build the command line program `exactvo`" ${PROJECT_IS_TOP_LEVEL})
  option(EXACTVO_WITH_GDAL "Read vector files through GDAL (plain WKT works without)" ON)
  find_package(MPI QUIET COMPONENTS CXX)
  option(EXACTVO_WITH_MPI "Spread a batch over MPI ranks (on where MPI is found)" ${MPI_CXX_FOUND})
  set(EXACTVO_PYTHON AUTO CACHE STRING "Build the Python package: ON, OFF, or AUTO, where pybind11 and Python's headers are")
  set_property(CACHE EXACTVO_PYTHON PROPERTY STRINGS AUTO ON OFF)
else()
  # Parts of the component datasets, whatever the cache says of an earlier configuration.
  set(EXACTVO_TOOLS OFF)
  set(EXACTVO_WITH_GDAL OFF)
  set(EXACTVO_WITH_MPI OFF)
  set(EXACTVO_PYTHON OFF)
endif()
set(EXACTVO_SANITIZE "" CACHE STRING "Sanitizers for every target, e.g. address,undefined or thread")

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
  endif()
  option(EXACTVO_UNITY "Compile the sources of a library eight at a time: a build from nothing takes a third less time" OFF)
  if(EXACTVO_UNITY)
    set(CMAKE_UNITY_BUILD ON)
    set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)
  endif()
  find_program(EXACTVO_CCACHE ccache)
  if(EXACTVO_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # Paths relative to the sources: clones of the project share what is compiled.
    set(CMAKE_CXX_COMPILER_LAUNCHER
      "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1 "${EXACTVO_CCACHE}")
  endif()
  # The default linker takes about four times as long for each of the hundred programs of the tests.
  if(NOT CMAKE_LINKER_TYPE AND NOT "${CMAKE_EXE_LINKER_FLAGS}" MATCHES "-fuse-ld=")
    include(CheckLinkerFlag)
    foreach(linker IN ITEMS mold lld)
      check_linker_flag(CXX -fuse-ld=${linker} EXACTVO_LINKS_WITH_${linker})
      if(EXACTVO_LINKS_WITH_${linker})
        add_link_options(-fuse-ld=${linker})
        break()
      endif()
    endforeach()
  endif()
endif()

add_library(exactvo_build_flags INTERFACE)
target_compile_features(exactvo_build_flags INTERFACE cxx_std_17)
target_compile_options(exactvo_build_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<BOOL:${EXACTVO_WERROR}>:-Werror>
  # The error bounds of the floating-point filters are derived for one rounding an operation.
  -ffp-contract=off)
if(EXACTVO_UNITY)
  # In one unit, names without linkage meet: local constants may shadow them, and types of headers look as if they were
  # made of them.
  target_compile_options(exactvo_build_flags INTERFACE -Wno-shadow -Wno-subobject-linkage)
endif()
if(EXACTVO_SANITIZE)
  target_compile_options(exactvo_build_flags INTERFACE
    -fsanitize=${EXACTVO_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(exactvo_build_flags INTERFACE -fsanitize=${EXACTVO_SANITIZE})
  # CGAL's lists cast the node behind their last element, which is none, to an element before they compare addresses.
  target_compile_options(exactvo_build_flags INTERFACE -fno-sanitize=vptr)
  # Instrumented code hides initialisations from GCC's flow analysis: it warns of CGAL's own temporaries.
  target_compile_options(exactvo_build_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()

# Links a module: what it holds of the libraries stays its own; nothing may be missing but what sanitizers bring.
function(exactvo_link_module module)
  target_link_options(${module} PRIVATE LINKER:--exclude-libs,ALL)
  if(NOT EXACTVO_SANITIZE)
    target_link_options(${module} PRIVATE LINKER:--no-undefined)
  endif()
endfunction()

# Sources of CGAL that are compiled together where sources are (EXACTVO_UNITY): those that make the same of its templates.
function(exactvo_compile_together group)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${group})
endfunction()

# Sources that compile themselves once for each SIMD target. SSSE3 without SSE4 is what processors of 2006 have: they take
# SSE2, and the others a fifth less time to compile. (Sanitizers leave out more: vo/CMakeLists.txt.)
function(exactvo_compile_for_each_target)
  if(NOT EXACTVO_SANITIZE)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_DEFINITIONS HWY_DISABLED_TARGETS=HWY_SSSE3)
  endif()
endfunction()
