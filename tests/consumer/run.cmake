# SPDX-License-Identifier: GPL-3.0-or-later
cmake_policy(VERSION 3.22)
string(REPLACE "," ";" COMPONENTS "${COMPONENTS}")

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed)
    message(FATAL_ERROR "${ARGV}\nended with ${failed}:\n${text}")
  endif()
  set(output "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/source)
file(GLOB programs ${SOURCE}/*.cpp)
file(COPY ${programs} DESTINATION ${WORK}/source)
file(COPY_FILE ${SOURCE}/project.cmake ${WORK}/source/CMakeLists.txt)

set(flags "")
if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE}")
endif()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

file(GLOB readme ${WORK}/prefix/share/doc/*/README.md)
list(LENGTH readme count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "installed READMEs: '${readme}'")
endif()
get_filename_component(documents "${readme}" DIRECTORY)
file(READ "${readme}" text)
string(REPLACE "](" "<link>" text "${text}")
string(REGEX REPLACE "[][;]" " " text "${text}")  # what CMake's lists read as their own
string(REGEX MATCHALL "<link>[a-zA-Z][^)#:<]*" links "${text}")
list(LENGTH links count)
if(count LESS 10)
  message(FATAL_ERROR "only ${count} links found in the README: the test looks for something else")
endif()
foreach(link ${links})
  string(REPLACE "<link>" "" target "${link}")
  if(NOT target MATCHES "^https?$" AND NOT EXISTS "${documents}/${target}")
    message(FATAL_ERROR "the installed README links to ${target}, which is not installed")
  endif()
endforeach()

set(toolchain -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_CXX_FLAGS=${flags})

# hide(<out> packages...): arguments with which find_package does not find them.
function(hide out)
  list(TRANSFORM ARGN PREPEND -DCMAKE_DISABLE_FIND_PACKAGE_)
  list(TRANSFORM ARGN APPEND =ON)
  set(${out} ${ARGN} PARENT_SCOPE)
endfunction()

# What no installed component may look for, and what one of them alone may.
set(nobody CGAL Boost Eigen3 nlohmann_json fmt CLI11 GTest rapidcheck benchmark)
set(of_vo TBB HWY)
set(of_datasets GDAL SQLite3 MPI pugixml yaml-cpp OpenSSL)

# try(<component> <what it prints> hidden packages...): configures, builds and runs a user of the component.
function(try component expected)
  hide(hidden ${nobody} ${ARGN})
  set(build ${WORK}/${component})
  run(${CMAKE_COMMAND} -S ${WORK}/source -B ${build} ${toolchain} -DCOMPONENT=${component} ${hidden})
  run(${CMAKE_COMMAND} --build ${build})
  execute_process(COMMAND ${build}/consumer WORKING_DIRECTORY ${build} OUTPUT_VARIABLE text RESULT_VARIABLE failed)
  if(failed OR NOT text MATCHES "${expected}")
    message(FATAL_ERROR "the consumer of ${component} ended with ${failed} and printed '${text}', not '${expected}'")
  endif()
endfunction()
if(geometry IN_LIST COMPONENTS)
  try(geometry "^4\n$" ${of_vo} ${of_datasets})
endif()
if(vo IN_LIST COMPONENTS)
  # The wall's near side is 3.5 m from the robot's rim and the horizon 2 s: 1.75 m/s straight on, rounded to the safe side.
  try(vo "^1\\.75 -?[0-9.e-]+\n$" ${of_datasets})
endif()
if(formation IN_LIST COMPONENTS)
  try(formation "^1\n$" ${of_datasets})
endif()
if(datasets IN_LIST COMPONENTS)
  try(datasets "^1\n$")
endif()

# ask(<words> arguments...): configuring ends with words that say why; with status 0 if the first argument is WORKS.
function(ask expected)
  cmake_parse_arguments(arg "WORKS" "" "" ${ARGN})
  file(REMOVE_RECURSE ${WORK}/asked)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/source -B ${WORK}/asked ${toolchain} ${arg_UNPARSED_ARGUMENTS}
                  RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  string(REGEX REPLACE "[ \n]+" " " text "${text}")  # CMake breaks lines
  string(FIND "${text}" "${expected}" place)
  if(place EQUAL -1 OR (failed AND arg_WORKS) OR (NOT failed AND NOT arg_WORKS))
    message(FATAL_ERROR "configuring with ${ARGN} ended with ${failed}; expected '${expected}' in:\n${text}")
  endif()
endfunction()
ask("ExactVO: there is no component 'geometri'; this installation has geometry" -DCOMPONENT=geometri)
if(datasets IN_LIST COMPONENTS)
  ask("ExactVO: component datasets needs pugixml, which was not found (Debian: libpugixml-dev)."
      -DCOMPONENT=datasets -DCMAKE_DISABLE_FIND_PACKAGE_pugixml=ON)
  ask("datasets found: 'FALSE'" WORKS
      -DCOMPONENT=vo "-DALSO=OPTIONAL_COMPONENTS datasets" -DCMAKE_DISABLE_FIND_PACKAGE_pugixml=ON)
  ask("datasets found: 'TRUE'" WORKS -DCOMPONENT=vo "-DALSO=OPTIONAL_COMPONENTS datasets")
endif()

# The installed examples are a project by themselves.
if(formation IN_LIST COMPONENTS)
  file(GLOB examples ${WORK}/prefix/share/doc/*/examples)
  hide(hidden ${nobody} ${of_datasets})
  run(${CMAKE_COMMAND} -S ${examples} -B ${WORK}/examples ${toolchain} ${hidden})
  run(${CMAKE_COMMAND} --build ${WORK}/examples)
  run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/examples --no-tests=error)
endif()

# Without CMake, by pkg-config.
find_program(pkg_config pkg-config)
if(formation IN_LIST COMPONENTS AND pkg_config)
  file(GLOB_RECURSE pc ${WORK}/prefix/*/exactvo.pc)
  get_filename_component(folder "${pc}" DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${folder})
  run(${pkg_config} --cflags --libs exactvo)
  separate_arguments(arguments UNIX_COMMAND "${output}")
  separate_arguments(sanitizing UNIX_COMMAND "${flags}")
  run(${COMPILER} -std=c++17 ${sanitizing} ${WORK}/source/formation.cpp -o ${WORK}/by_pkg_config ${arguments})
  run(${WORK}/by_pkg_config)
  if(NOT output STREQUAL "1\n")
    message(FATAL_ERROR "the consumer by pkg-config printed '${output}'")
  endif()
endif()

# The installed program finds the scenarios that were installed with it.
if(EXISTS ${WORK}/prefix/${BINDIR}/exactvo)
  run(${WORK}/prefix/${BINDIR}/exactvo --version)
  run(${WORK}/prefix/${BINDIR}/exactvo simulate ${WORK}/prefix/share/exactvo/data/paper/A10.json --json)
endif()
