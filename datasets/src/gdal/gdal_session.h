// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// GDAL brought to heel: drivers registered once, its complaints collected instead of printed, datasets closed.

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "exactvo/datasets/local_plane.h"
#include "files/file_names.h"

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

/// The driver that would open the file, by its content and name; "" where there is none.
std::string vector_driver_of(const std::filesystem::path& path);

/// Only drivers that read a local file of vectors: none that follow links to other files or to the network. `driver`:
/// that of `vector_driver_of`. Throws DataError (E_SIZE) for KML and TopoJSON, which GDAL parses whole, where that
/// would take more memory than a reader may (20 bytes for each of the input and 200 MB beside), estimated from the
/// points of KML, and from the objects, lists and values of TopoJSON (gdal/json_memory.h).
std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path, const std::string& driver);

/// In this thread while it lives: holds each feature of a GeoJSON collection to the same memory, by GDAL's estimate of
/// its size, and makes no fields of properties, which are read from the native data of the features.
class GeoJsonParsing {
 public:
  explicit GeoJsonParsing(const std::filesystem::path& path);
  ~GeoJsonParsing();
  GeoJsonParsing(const GeoJsonParsing&) = delete;
  GeoJsonParsing& operator=(const GeoJsonParsing&) = delete;

  /// Whether these are GDAL's words for a feature beyond the limit.
  static bool is_size_limit_in(const std::string& complaint);
};

// --- Reference systems of local planes (layer_plane.cpp) ---

/// The azimuthal equidistant projection of `geographic` round `origin`.
OGRSpatialReference plane_round(const OGRSpatialReference& geographic, const ProjectionOrigin& origin);

/// On one line (WKT 2:2019); empty where it can't be told.
std::string wkt_of(const OGRSpatialReference& system);

}  // namespace exactvo::datasets
