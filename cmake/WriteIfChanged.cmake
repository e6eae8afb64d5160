# SPDX-License-Identifier: GPL-3.0-or-later
# exactvo_write_if_changed(OUT TEXT): so that what was compiled from OUT is not compiled again.
function(exactvo_write_if_changed out text)
  set(written "")
  if(EXISTS "${out}")
    file(READ "${out}" written)
  endif()
  if(NOT written STREQUAL text)
    file(WRITE "${out}" "${text}")
  endif()
endfunction()
