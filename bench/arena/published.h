// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What others have published about scenes like those of the arena, and how far it can be compared.

#include <string>
#include <vector>

namespace exactvo::bench {

struct Published {
  std::string suite, scenes, figure;
  std::string source;  ///< author, title, where
  bool comparable = false;
  std::string why;  ///< what is the same, and what differs
};

const std::vector<Published>& published();

}  // namespace exactvo::bench
