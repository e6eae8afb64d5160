// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/projection.h"

#include <fmt/format.h>

#include "support/terminal.h"

namespace exactvo::tools {

std::string projection_line(const datasets::ObstacleFile& file) {
  if (!file.origin) return "";
  return fmt::format("{}: projected from degrees to metres, centred on longitude {}, latitude {}", file.file,
                     file.origin->longitude, file.origin->latitude);
}

void say_projection(const datasets::ObstacleFile& file) {
  if (const std::string line = projection_line(file); !line.empty())
    message(line + "; --units metres takes them as they stand");
}

}  // namespace exactvo::tools
