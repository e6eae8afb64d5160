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

  /// The first failure since the last call, or ""; one that a geometry is malformed comes after all others.
  std::string take_failure();
  /// The first one that a geometry is malformed (GDAL's words begin with "Invalid "), or "". Others stay.
  std::string take_malformed();
  std::vector<std::string> take_warnings();

 private:
  static void CPL_STDCALL hear(CPLErr severity, CPLErrorNum number, const char* words);

  std::string failure_;
  std::string malformed_;
  std::vector<std::string> warnings_;
};

void register_gdal_once();

/// Only drivers that read a local file of vectors: none that follow links to other files or to the network.
std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path);

}  // namespace exactvo::datasets
