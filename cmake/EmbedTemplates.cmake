# SPDX-License-Identifier: GPL-3.0-or-later
# exactvo_embed_templates(OUT FILES...): writes OUT, a source file with the text of FILES, gnuplot templates and JSON, so
# that the program needs no files of its own.
include(WriteIfChanged)

function(exactvo_embed_templates out)
  set(entries "")
  foreach(file ${ARGN})
    get_filename_component(name "${file}" NAME_WE)
    file(READ "${file}" text)
    string(APPEND entries "      {\"${name}\", R\"template(${text})template\"},\n")
  endforeach()
  set(source "// Made by cmake/EmbedTemplates.cmake of the files that tools/CMakeLists.txt names.
#include \"figures/figure.h\"

namespace exactvo::tools {

const std::map<std::string, std::string>& embedded_templates() {
  static const std::map<std::string, std::string> kTemplates{
${entries}  };
  return kTemplates;
}

}  // namespace exactvo::tools
")
  exactvo_write_if_changed("${out}" "${source}")
endfunction()
