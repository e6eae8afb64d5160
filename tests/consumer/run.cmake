# SPDX-License-Identifier: GPL-3.0-or-later
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed)
    message(FATAL_ERROR "${ARGV}\nended with ${failed}:\n${text}")
  endif()
  set(output "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/source)
file(COPY ${SOURCE}/main.cpp DESTINATION ${WORK}/source)
file(COPY_FILE ${SOURCE}/project.cmake ${WORK}/source/CMakeLists.txt)

set(flags "")
if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE}")
endif()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${WORK}/source -B ${WORK}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_FLAGS=${flags})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
# The wall's near side is 3.5 m from the robot's rim and the horizon 2 s: 1.75 m/s straight on, rounded to the safe side.
if(NOT output MATCHES "^1\\.75 -?[0-9.e-]+\n$")
  message(FATAL_ERROR "the consumer printed '${output}', not '1.75 0'")
endif()

# The installed program finds the scenarios that were installed with it.
if(EXISTS ${WORK}/prefix/${BINDIR}/exactvo)
  run(${WORK}/prefix/${BINDIR}/exactvo --version)
  run(${WORK}/prefix/${BINDIR}/exactvo simulate ${WORK}/prefix/share/exactvo/data/paper/A10.json --json)
endif()
