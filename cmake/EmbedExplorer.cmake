# SPDX-License-Identifier: GPL-3.0-or-later
# exactvo_embed_explorer(OUT FOLDER): writes OUT, a source file with the page of `exactvo view` in one piece: page.html
# of FOLDER with page.css and the modules of modules.txt in it, in that order. The modules are ECMAScript modules that a
# browser or node runs as they are; joined, they share one scope, so their imports (a line each) and exports (a list at
# the end) are left out.
# No other tool is needed to build the page. What asks a server (served.js) stands apart: pages from a file have none of
# it.
include(WriteIfChanged)

# Compilers bound the length of one literal; adjacent ones are joined.
function(exactvo_literals out text)
  set(literals "")
  string(LENGTH "${text}" rest)
  set(from 0)
  while(from LESS rest)
    string(SUBSTRING "${text}" ${from} 12000 piece)
    string(APPEND literals "R\"explorer(${piece})explorer\"\n")
    math(EXPR from "${from} + 12000")
  endwhile()
  set(${out} "${literals}" PARENT_SCOPE)
endfunction()

function(exactvo_embed_explorer out folder)
  file(STRINGS "${folder}/modules.txt" modules)
  set(script "")
  foreach(module IN LISTS modules)
    file(READ "${folder}/${module}" text)
    string(PREPEND text "\n")
    string(REGEX REPLACE "\nimport [^\n]*" "" text "${text}")
    string(REGEX REPLACE "\nexport {[^}]*};" "" text "${text}")
    string(REGEX REPLACE "\n// SPDX[^\n]*" "" text "${text}")
    string(APPEND script "${text}")
  endforeach()
  file(READ "${folder}/page.css" style)
  file(READ "${folder}/page.html" page)
  string(REPLACE "__STYLE__" "${style}" page "${page}")
  string(REPLACE "__SCRIPT__" "${script}" page "${page}")
  file(READ "${folder}/served.js" served)
  exactvo_literals(page_literals "${page}")
  exactvo_literals(served_literals "${served}")
  set(source "// Made by cmake/EmbedExplorer.cmake of tools/explorer/page.
#include \"explorer/page.h\"

namespace exactvo::tools {

const char* const kExplorerShell =
${page_literals};

const char* const kServedScript =
${served_literals};

}  // namespace exactvo::tools
")
  exactvo_write_if_changed("${out}" "${source}")
endfunction()
