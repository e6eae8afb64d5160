// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// GDAL brought to heel: drivers registered once, its complaints collected instead of printed, datasets closed.

#include <gdal_priv.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace exactvo::datasets {

/// While it lives, what GDAL has to say in this thread lands here.
class GdalComplaints {
 public:
  GdalComplaints();
  ~GdalComplaints();
  GdalComplaints(const GdalComplaints&) = delete;
  GdalComplaints& operator=(const GdalComplaints&) = delete;

  /// The first failure since the last call, or "".
  std::string take_failure();
  std::vector<std::string> take_warnings();

 private:
  static void CPL_STDCALL hear(CPLErr severity, CPLErrorNum number, const char* words);

  std::string failure_;
  std::vector<std::string> warnings_;
};

void register_gdal_once();

/// The driver that would open the file, by its content and name; "" where there is none.
std::string vector_driver_of(const std::filesystem::path& path);

/// Only drivers that read a local file of vectors: none that follow links to other files or to the network. `driver`:
/// that of `vector_driver_of`. Throws DataError (E_SIZE) for KML and TopoJSON, which GDAL parses whole, where that
/// would take more memory than a reader may (20 bytes for each of the input and 200 MB beside), estimated from the
/// points of KML, and from the objects, lists and values of TopoJSON (gdal/json_memory.h).
std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path, const std::string& driver);

}  // namespace exactvo::datasets
