# SPDX-License-Identifier: GPL-3.0-or-later
# `cmake --build BUILD --target site`: guide, reference, gallery, tutorials and explorer as plain files in BUILD/site.
find_program(EXACTVO_SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(EXACTVO_SYSTEM_PYTHON python3)
if(EXACTVO_SYSTEM_PYTHON AND TARGET exactvo)
  set(site_python "")
  if(EXACTVO_BUILDS_PYTHON)
    set(site_python --python ${PROJECT_BINARY_DIR}/python)
    set(EXACTVO_SITE_PYTHON ${Python3_EXECUTABLE})
  else()
    set(EXACTVO_SITE_PYTHON ${EXACTVO_SYSTEM_PYTHON})
  endif()
  add_custom_target(site
    COMMAND ${EXACTVO_SITE_PYTHON} ${PROJECT_SOURCE_DIR}/scripts/make_site.py ${PROJECT_BINARY_DIR}/site
      --program $<TARGET_FILE:exactvo> ${site_python}
    USES_TERMINAL VERBATIM)
  add_dependencies(site exactvo)
  if(EXACTVO_BUILDS_PYTHON)
    add_dependencies(site exactvo_python)
  endif()
endif()
