// SPDX-License-Identifier: GPL-3.0-or-later
#include "explorer/deflate.h"

#include <zlib.h>

#include <stdexcept>

namespace exactvo::tools {

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  const int result =
      compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION);
  if (result != Z_OK) throw std::runtime_error("zlib: compress2 failed with " + std::to_string(result));
  out.resize(size);
  return out;
}

}  // namespace exactvo::tools
