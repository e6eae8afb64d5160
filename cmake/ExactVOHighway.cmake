# SPDX-License-Identifier: GPL-3.0-or-later
# Highway, for SIMD lanes: what to link with, exactvo_highway. The library of version 1.0.3 measures its timer
# for 3 ms in every process that is linked with it, and no more of it is used than which targets the processor has. The GNU C
# library knows that on x86 (since 2.33): vo/src/lp/lanes/targets.cpp asks it, and Highway's headers go by another name in
# this project, so that a user's own Highway is not disturbed.
include(CheckIncludeFileCXX)
check_include_file_cxx(sys/platform/x86.h EXACTVO_HAS_FEATURES_OF_GLIBC)
if(HWY_VERSION VERSION_EQUAL 1.0.3 AND EXACTVO_HAS_FEATURES_OF_GLIBC)
  add_library(exactvo_highway_headers INTERFACE)
  target_include_directories(exactvo_highway_headers INTERFACE $<TARGET_PROPERTY:hwy::hwy,INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_definitions(exactvo_highway_headers INTERFACE hwy=exactvo_hwy)
  set(exactvo_highway $<BUILD_INTERFACE:exactvo_highway_headers>)
  set(exactvo_highway_sources src/lp/lanes/targets.cpp)
  set(EXACTVO_LINKED_HIGHWAY "")
  set(EXACTVO_HIGHWAY_PACKAGE "")
else()
  set(exactvo_highway hwy::hwy)
  set(exactvo_highway_sources "")
  set(EXACTVO_LINKED_HIGHWAY "-lhwy ")
  set(EXACTVO_HIGHWAY_PACKAGE ", libhwy-dev")
endif()
