// SPDX-License-Identifier: GPL-3.0-or-later
#include <exactvo/datasets/obstacle_file.h>

#include <fstream>
#include <iostream>
int main() {
  using namespace exactvo::datasets;
  // GeoJSON goes through GDAL, where there is one.
  const bool gdal = built_with_gdal();
  const char* const name = gdal ? "square.geojson" : "square.wkt";
  std::ofstream(name) << (gdal ? R"({"type": "Polygon", "coordinates": [[[0, 0], [0.001, 0], [0.001, 0.001], [0, 0]]]})"
                               : "POLYGON((0 0, 1 0, 1 1, 0 0))");
  std::cout << read_obstacles(name).obstacles.size() << "\n";  // 1
}
