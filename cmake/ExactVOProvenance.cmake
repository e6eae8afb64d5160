# SPDX-License-Identifier: GPL-3.0-or-later
# The commit that a build was made from, as a header that changes only when the commit does.
find_package(Git QUIET)
set(EXACTVO_PROVENANCE_DIR "${PROJECT_BINARY_DIR}/generated")
add_custom_target(exactvo_provenance
  COMMAND ${CMAKE_COMMAND} -DGIT=${GIT_EXECUTABLE} -DSOURCE=${PROJECT_SOURCE_DIR}
          -DOUT=${EXACTVO_PROVENANCE_DIR}/exactvo_commit.h -P ${PROJECT_SOURCE_DIR}/cmake/write_commit.cmake
  BYPRODUCTS ${EXACTVO_PROVENANCE_DIR}/exactvo_commit.h
  VERBATIM)
