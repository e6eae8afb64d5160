# SPDX-License-Identifier: GPL-3.0-or-later
# Configures parts of the project where the libraries of the other parts are absent.
cmake_policy(VERSION 3.22)

# configure(<name> <absent packages> arguments...): in a build folder of its own.
function(configure name absent)
  file(REMOVE_RECURSE ${WORK}/${name})
  list(TRANSFORM absent PREPEND -DCMAKE_DISABLE_FIND_PACKAGE_)
  list(TRANSFORM absent APPEND =ON)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/${name} -G ${GENERATOR}
                          -DCMAKE_CXX_COMPILER=${COMPILER} ${absent} ${ARGN}
                  RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(failed "${failed}" PARENT_SCOPE)
  set(text "${text}" PARENT_SCOPE)
  if(EXISTS ${WORK}/${name}/CMakeCache.txt)
    file(STRINGS ${WORK}/${name}/CMakeCache.txt asked REGEX "^EXACTVO_VALIJSON_INCLUDE")
    set(asked_for_valijson "${asked}" PARENT_SCOPE)
  endif()
endfunction()

set(of_datasets GDAL SQLite3 MPI pugixml yaml-cpp OpenSSL fmt CLI11)
set(of_tests GTest rapidcheck)
set(no_tests -DEXACTVO_TESTS=OFF -DEXACTVO_BENCH=OFF)

configure(vo "${of_datasets};${of_tests};nlohmann_json;benchmark" -DEXACTVO_COMPONENTS=vo ${no_tests})
if(failed OR asked_for_valijson)
  message(FATAL_ERROR "geometry and vo alone: status ${failed}, valijson '${asked_for_valijson}'\n${text}")
endif()
configure(geometry "${of_datasets};${of_tests};nlohmann_json;benchmark;TBB;HWY" -DEXACTVO_COMPONENTS=geometry ${no_tests})
if(failed)
  message(FATAL_ERROR "geometry alone: status ${failed}\n${text}")
endif()
# The programs among the tests take options, as the benches do.
set(of_options fmt CLI11)
set(needless_for_tests ${of_datasets})
list(REMOVE_ITEM needless_for_tests ${of_options})
configure(vo_with_tests "${needless_for_tests}" -DEXACTVO_COMPONENTS=vo -DEXACTVO_BENCH=OFF)
if(failed OR asked_for_valijson)
  message(FATAL_ERROR "vo with its tests: status ${failed}, valijson '${asked_for_valijson}'\n${text}")
endif()
configure(without_gdal "GDAL;SQLite3;MPI;${of_tests};benchmark" -DEXACTVO_WITH_GDAL=OFF ${no_tests})
if(failed OR asked_for_valijson)
  message(FATAL_ERROR "all without GDAL and MPI: status ${failed}, valijson '${asked_for_valijson}'\n${text}")
endif()

# What is missing is named with its package and with the way round it.
configure(gdal_is_missing "GDAL" ${no_tests})
if(NOT failed OR NOT text MATCHES "GDAL was not found.*libgdal-dev.*EXACTVO_WITH_GDAL=OFF")
  message(FATAL_ERROR "without GDAL: status ${failed}\n${text}")
endif()
configure(unknown "" -DEXACTVO_COMPONENTS=formations)
if(NOT failed OR NOT text MATCHES "names 'formations'")
  message(FATAL_ERROR "a component that does not exist: status ${failed}\n${text}")
endif()
