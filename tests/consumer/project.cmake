# SPDX-License-Identifier: GPL-3.0-or-later
cmake_minimum_required(VERSION 3.22)
project(Consumer LANGUAGES CXX)
find_package(ExactVO REQUIRED)
add_executable(consumer main.cpp)
target_link_libraries(consumer PRIVATE exactvo::formation exactvo::datasets)
