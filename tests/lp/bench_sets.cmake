# SPDX-License-Identifier: GPL-3.0-or-later
# Of a file of two problems, of which one is feasible, the sets that are named are run, and nothing else.
# Binary instances: count; m, m_hard, v_max, v_pref; a line each, the infeasible one's 2 m/s to the left, at most 1 m/s.
set(file ${WORK}/two_instances.bin)
set(zero "\\0\\0\\0\\0")
set(one "\\0\\0\\200\\077")
set(two "\\0\\0\\0\\100")
set(soft_line_at "\\1\\0\\0\\0${zero}${one}${zero}${zero}")
execute_process(COMMAND printf "\\2\\0\\0\\0${soft_line_at}${zero}${zero}${one}${zero}${soft_line_at}${zero}${two}${one}${zero}"
                OUTPUT_FILE ${file})
foreach(sets "filef" "filei,RF3" "")
  if(sets)
    set(given --sets ${sets})
  else()
    set(given)
    set(sets "file,filef,filei")
  endif()
  execute_process(COMMAND ${BENCH_LP} --instances ${file} ${given} --rounds 1
                  RESULT_VARIABLE status OUTPUT_VARIABLE table ERROR_VARIABLE words)
  string(REGEX MATCHALL "\n[A-Za-z0-9]+: [0-9]+ problems, [0-9]+ feasible" run "${table}")
  string(REGEX REPLACE "\n([A-Za-z0-9]+): [0-9]+ problems, [0-9]+ feasible;?" "\\1," run "${run}")
  if(NOT status EQUAL 0 OR NOT run STREQUAL "${sets},")
    message(FATAL_ERROR "--sets ${sets}: status ${status}, ran ${run} ${words}")
  endif()
endforeach()
if(NOT table MATCHES "file: 2 problems, 1 feasible.*filef: 1 problems, 1 feasible.*filei: 1 problems, 0 feasible")
  message(FATAL_ERROR "parts: ${table}")
endif()
