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

# The lines of JSON that `exactvo lp` reads are the same problems; a normal may have any length.
set(lines ${WORK}/two_instances.jsonl)
file(WRITE ${lines} "{\"bound\": {\"disc\": 1}, \"preferred\": [1, 0], \"constraints\": [{\"normal\": [-2, 0], \"offset\": -1}]}
{\"bound\": {\"disc\": 1}, \"preferred\": [1, 0], \"constraints\": [{\"normal\": [-1, 0], \"offset\": 2, \"priority\": \"soft\"}]}
")
execute_process(COMMAND ${BENCH_LP} --instances ${lines} --rounds 1
                RESULT_VARIABLE status OUTPUT_VARIABLE table ERROR_VARIABLE words)
if(READS_LINES AND (NOT status EQUAL 0 OR NOT table MATCHES "file: 2 problems, 1 feasible.*filei: 1 problems, 0 feasible"))
  message(FATAL_ERROR "lines of JSON: status ${status}, ${table} ${words}")
endif()
if(NOT READS_LINES AND NOT words MATCHES "lines of JSON are read where datasets is built")
  message(FATAL_ERROR "lines of JSON without datasets: ${words}")
endif()

# So are those of CSV, a row per half-plane.
set(table ${WORK}/two_instances.csv)
file(WRITE ${table} "problem,disc,preferred_x,preferred_y,normal_x,normal_y,offset,priority
first,1,1,0,-2,0,-1,hard
second,1,1,0,-1,0,2,soft
")
execute_process(COMMAND ${BENCH_LP} --instances ${table} --rounds 1
                RESULT_VARIABLE status OUTPUT_VARIABLE words_of_table ERROR_VARIABLE words)
if(READS_LINES AND (NOT status EQUAL 0 OR NOT words_of_table MATCHES "file: 2 problems, 1 feasible.*filei: 1 problems, 0 feasible"))
  message(FATAL_ERROR "CSV: status ${status}, ${words_of_table} ${words}")
endif()

# What not every solver here takes is refused by its number.
file(APPEND ${lines} "{\"bound\": {\"box\": [1, 1]}, \"preferred\": [1, 0], \"constraints\": []}\n")
execute_process(COMMAND ${BENCH_LP} --instances ${lines} --rounds 1 RESULT_VARIABLE status ERROR_VARIABLE words OUTPUT_QUIET)
if(READS_LINES AND (NOT status EQUAL 2 OR NOT words MATCHES "problem 3: found a box, expected a disc"))
  message(FATAL_ERROR "a box: status ${status}, ${words}")
endif()
