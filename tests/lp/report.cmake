# SPDX-License-Identifier: GPL-3.0-or-later
# The arena's page: made from two small results, it says what is wrong beside what is fast; given in the wrong order,
# they are refused in words.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(rows "")
foreach(set C5 C10)
  foreach(solver textbook batch-float exact)
    set(ratios "1, 1, 1")
    if(solver STREQUAL "batch-float")
      set(ratios "4, 5, 6")
    elseif(solver STREQUAL "exact")
      set(ratios "4.5, 5.5, 4.2")
    endif()
    string(APPEND rows "{\"name\": \"${set}/${solver}\", \"ratios\": [${ratios}], \"cpu_time\": 40, \"wrong_verdicts\": 10, \"inaccurate\": 28, \"worst_violation\": 0},")
  endforeach()
endforeach()
string(REGEX REPLACE ",$" "" rows "${rows}")
file(WRITE ${WORK}/arena.json "{\"context\": {\"cpu\": \"a processor\", \"simd_target\": \"AVX2\", \"compiler\": \"12.2\"}, \"benchmarks\": [${rows}],
  \"figures\": [{\"what\": \"C10, double\", \"reach\": 4, \"measured\": 2, \"at_most\": false, \"reached\": false}]}")
file(WRITE ${WORK}/adversarial.json "{\"adversarial\": [{\"perturbation\": \"1e-3\", \"solver\": \"exact\",
  \"false_infeasible\": 0, \"false_feasible\": 0, \"problems\": 10}, {\"perturbation\": \"1e-3\", \"solver\": \"textbook\",
  \"false_infeasible\": 1, \"false_feasible\": 0, \"problems\": 10}]}")

execute_process(COMMAND ${LP_REPORT} ${WORK}/adversarial.json ${WORK}/arena.json ${WORK}/page
                RESULT_VARIABLE status ERROR_VARIABLE words)
if(NOT status EQUAL 2 OR NOT words MATCHES "adversarial.json: found no list \"benchmarks\"" OR EXISTS ${WORK}/page)
  message(FATAL_ERROR "swapped files: status ${status}, ${words}")
endif()

execute_process(COMMAND ${LP_REPORT} ${WORK}/arena.json ${WORK}/adversarial.json ${WORK}/page
                RESULT_VARIABLE status ERROR_VARIABLE words)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "status ${status}, ${words}")
endif()
file(READ ${WORK}/page/report.html page)
# Intervals that overlap share a rank.
foreach(text "<td>1</td><td class=.words.>batch-float</td><td>2</td><td>5</td><td>4 to 6</td>"
    "<td>1</td><td class=.words.>exact</td><td>2</td><td>4.5</td><td>4.2 to 5.5</td>"
    "<td>3</td><td class=.words.>textbook</td><td>2</td><td>1</td><td>1 to 1</td>"
    "Processor a processor, SIMD target AVX2, compiler 12.2" "10 / 28 / 0" "a processor" "Figures to reach" ">short<" "Where and how")
  if(NOT page MATCHES "${text}")
    message(FATAL_ERROR "the page does not have '${text}'")
  endif()
endforeach()
foreach(picture time-C profile accuracy)
  file(READ ${WORK}/page/${picture}.gp script)
  if(NOT script MATCHES "lc rgb '#CC79A7' dt 2 title 'exact'" OR NOT script MATCHES "lc rgb '#555555' title 'textbook'")
    message(FATAL_ERROR "${picture}: a solver has another colour than elsewhere:\n${script}")
  endif()
endforeach()

# Neither a folder nor a solver is a command, for the shell, for gnuplot or for a reader of the page.
set(folder "${WORK}/a'$(touch ${WORK}/pwned)'`touch ${WORK}/pwned`")
set(solver "'.system('touch ${WORK}/pwned').'<script>")
string(REPLACE "textbook" "${solver}" rows "${rows}")
file(WRITE ${WORK}/arena.json "{\"benchmarks\": [${rows}], \"context\": {}}")
execute_process(COMMAND ${LP_REPORT} ${WORK}/arena.json ${WORK}/adversarial.json ${folder}
                RESULT_VARIABLE status ERROR_VARIABLE words)
if(NOT status EQUAL 0 OR NOT EXISTS ${folder}/time-C.png OR EXISTS ${WORK}/pwned)
  message(FATAL_ERROR "a folder or a solver is taken for a command: status ${status}, ${words}")
endif()
file(READ ${folder}/report.html page)
if(page MATCHES "<script>")
  message(FATAL_ERROR "a solver's name is markup in the page")
endif()
