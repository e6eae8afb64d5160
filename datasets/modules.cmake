# SPDX-License-Identifier: GPL-3.0-or-later
# The parts of this component as modules in the library folder beside a program's, and the code that loads them.
# A path from one folder to the other, so that a build tree and every prefix look alike.
file(RELATIVE_PATH EXACTVO_MODULE_FOLDER ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/exactvo)
set(EXACTVO_MODULE_FOLDER ${EXACTVO_MODULE_FOLDER} CACHE INTERNAL "Modules, seen from the program's folder")
set(build "EXACTVO_VERSION=\"${PROJECT_VERSION}\"")

# Objects, not an archive: the datasets library refers back to it, and a linker reads an archive once.
add_library(exactvo_datasets_loader OBJECT src/modules/loader.cpp)
target_include_directories(exactvo_datasets_loader PRIVATE src ${EXACTVO_PROVENANCE_DIR})
target_compile_definitions(exactvo_datasets_loader PRIVATE ${build} EXACTVO_MODULE_FOLDER="${EXACTVO_MODULE_FOLDER}")
target_link_libraries(exactvo_datasets_loader PUBLIC exactvo_datasets PRIVATE ${CMAKE_DL_LIBS} exactvo_build_flags)
add_dependencies(exactvo_datasets_loader exactvo_provenance)

# What a program that loads them depends on: objects bring no targets of theirs along.
add_custom_target(exactvo_datasets_modules)
get_property(parts GLOBAL PROPERTY EXACTVO_PARTS_OF_datasets)
foreach(part IN LISTS parts)
  set(module exactvo_${part}_module)
  add_library(${module} MODULE src/modules/${part}_module.cpp)
  target_include_directories(${module} PRIVATE src ${EXACTVO_PROVENANCE_DIR})
  target_compile_definitions(${module} PRIVATE ${build})
  target_link_libraries(${module} PRIVATE exactvo_datasets_${part} exactvo_datasets exactvo_build_flags)
  exactvo_link_module(${module})
  set_target_properties(${module} PROPERTIES PREFIX "" OUTPUT_NAME exactvo_${part} CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin/${EXACTVO_MODULE_FOLDER})
  add_dependencies(${module} exactvo_provenance)
  add_dependencies(exactvo_datasets_modules ${module})
  string(TOUPPER ${part} upper)
  target_compile_definitions(exactvo_datasets_loader PRIVATE EXACTVO_LOADS_${upper})
  install(TARGETS ${module} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/exactvo COMPONENT runtime)
endforeach()
