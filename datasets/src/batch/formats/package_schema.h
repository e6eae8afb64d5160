// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// An empty GeoPackage with the layers of a batch, as GDAL makes it: tables, spatial indices, extensions, metadata.

#include <filesystem>
#include <string>

namespace exactvo::datasets::batch {

/// Its bytes, the same for the same provenance: the times that the format records are those of 1970. `path` is for what
/// errors say. Throws DataError (E_FILE_UNWRITABLE).
std::string empty_package(const std::string& provenance, const std::filesystem::path& path);

}  // namespace exactvo::datasets::batch
