// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The paper's equations, one by one: what is printed, what is implemented, and where.

#include <string>
#include <vector>

namespace exactvo::tools {

struct EquationPlace {
  std::string file;    ///< from the top of the sources
  std::string symbol;  ///< a name that stands in it
};

struct Equation {
  std::string number;       ///< "(15)"
  std::string printed;      ///< the paper's, in plain text
  std::string trouble;      ///< what is wrong with it; empty where nothing is
  std::string implemented;  ///< what runs by default
  std::vector<EquationPlace> places;
};

/// In the paper's order. A test sees that the files exist and hold the names.
const std::vector<Equation>& equations();

}  // namespace exactvo::tools
