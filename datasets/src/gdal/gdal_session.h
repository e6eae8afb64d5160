// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// GDAL brought to heel: drivers registered once, its complaints collected instead of printed, datasets closed.

#include <gdal_priv.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactvo/datasets/data_error.h"

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

/// Only drivers that read a local file of vectors: none that follow links to other files or to the network. Throws
/// DataError (E_SIZE) for TopoJSON, or a line of a sequence, that `bulky_json` finds something in.
std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path);

/// Readers may take 20 bytes of memory for each of the input and 200 MB beside. What would take more of json-c, the
/// parser of GDAL, in which a point of two digits takes 300 bytes; nothing where the text fits.
std::optional<DataError> bulky_json(std::string_view text, const std::string& file, const std::string& place);

/// The same of a feature of GeoJSON, which GDAL holds to its own estimate of sizes: in this thread while it lives.
class GeoJsonSizeLimit {
 public:
  explicit GeoJsonSizeLimit(const std::filesystem::path& path);
  ~GeoJsonSizeLimit();
  GeoJsonSizeLimit(const GeoJsonSizeLimit&) = delete;
  GeoJsonSizeLimit& operator=(const GeoJsonSizeLimit&) = delete;

  /// Whether these are GDAL's words for a feature beyond the limit.
  static bool is_said_in(const std::string& complaint);
};

}  // namespace exactvo::datasets
