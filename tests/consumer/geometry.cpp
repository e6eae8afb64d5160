// SPDX-License-Identifier: GPL-3.0-or-later
#include <exactvo/geometry/hull.h>

#include <iostream>
int main() {
  std::cout << exactvo::geometry::convex_hull({{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}}).vertices.size() << "\n";  // 4
}
