// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <string>

#include "files/unique_word.h"

namespace exactvo::datasets {

/// A file that GDAL makes in memory, gone with the object. A GeoPackage records when it was written: as long as it
/// lives, that is `date` in this thread, so that equal content is equal bytes.
class MemoryFile {
 public:
  MemoryFile(const std::string& extension, const char* date) : name_("/vsimem/" + unique_word() + extension) {
    CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", date);
  }
  ~MemoryFile() {
    CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr);
    VSIUnlink(name_.c_str());
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const char* name() const { return name_.c_str(); }
  std::string bytes() const {
    vsi_l_offset length = 0;
    const GByte* data = VSIGetMemFileBuffer(name(), &length, FALSE);
    return data == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(data), length);
  }

 private:
  std::string name_;
};

}  // namespace exactvo::datasets
