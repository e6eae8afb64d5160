# SPDX-License-Identifier: GPL-3.0-or-later
# A user of one component: -DCOMPONENT=geometry. What find_package says of others: -DALSO="OPTIONAL_COMPONENTS datasets".
cmake_minimum_required(VERSION 3.22)
project(Consumer LANGUAGES CXX)
separate_arguments(ALSO)
find_package(ExactVO REQUIRED COMPONENTS ${COMPONENT} ${ALSO})
message(STATUS "datasets found: '${ExactVO_datasets_FOUND}'")
add_executable(consumer ${COMPONENT}.cpp)
target_link_libraries(consumer PRIVATE exactvo::${COMPONENT})
