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
#include <utility>
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

  /// The first failure since the last call, or "".
  std::string take_failure() { return std::exchange(failure_, {}); }
  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

 private:
  static void CPL_STDCALL hear(CPLErr severity, CPLErrorNum number, const char* words);

  std::string failure_;
  std::vector<std::string> warnings_;
};

void register_gdal_once();

/// An option of GDAL's, in this thread, as long as it lives.
class ConfigOption {
 public:
  ConfigOption(const char* name, const char* value) : name_(name) { CPLSetThreadLocalConfigOption(name, value); }
  ~ConfigOption() { CPLSetThreadLocalConfigOption(name_, nullptr); }
  ConfigOption(const ConfigOption&) = delete;
  ConfigOption& operator=(const ConfigOption&) = delete;

 private:
  const char* name_;
};

/// A GeoPackage records when it was written: that is one and the same moment, so that equal content is equal bytes.
struct FixedDate : ConfigOption {
  FixedDate() : ConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z") {}
};

/// A file that GDAL makes in memory, gone with the object.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& extension) : name_("/vsimem/" + unique_word() + extension) {}
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const char* name() const { return name_.c_str(); }
  std::string bytes() const {
    vsi_l_offset length = 0;
    const GByte* data = VSIGetMemFileBuffer(name(), &length, FALSE);
    return data == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(data), length);
  }

 private:
  FixedDate date_;
  std::string name_;
};

/// Bytes that a reader may take for `input_bytes` of input: 20 for each and 200 MB beside, of which the libraries of
/// the process have a share.
double parser_memory_for(double input_bytes);

/// The driver that would open the file, by its content and name; "" where there is none.
std::string vector_driver_of(const std::filesystem::path& path);

/// Only drivers that read a local file of vectors: none that follow links to other files or to the network. `driver`:
/// that of `vector_driver_of`. Throws DataError (E_SIZE) for KML and TopoJSON, which GDAL parses whole, where that
/// would take more memory than a reader may (20 bytes for each of the input and 200 MB beside), estimated from the
/// points of KML, and from the objects, lists and values of TopoJSON.
std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path, const std::string& driver);

// --- Reference systems of local planes (layer_plane.cpp) ---

/// The azimuthal equidistant projection of `geographic` round `origin`.
OGRSpatialReference plane_round(const OGRSpatialReference& geographic, const ProjectionOrigin& origin);

/// EPSG:`srid`, longitudes and eastings first. Throws DataError (E_PROJECTION) where PROJ does not know it.
OGRSpatialReference system_of_srid(int srid, const std::string& file, GdalComplaints& complaints);

/// On one line (WKT 2:2019); empty where it can't be told.
std::string wkt_of(const OGRSpatialReference& system);

}  // namespace exactvo::datasets
