// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/data_error.h"
#include "gdal/gdal_session.h"
#include "readers/grid.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

/// This many rows stay with GDAL: 4 MB of the widest that are usual.
constexpr std::size_t kRowsKept = 128;

const char* const kImageDrivers[] = {"PNG", "BMP", "JPEG", nullptr};

/// A palette's colour as one brightness.
float brightness_of(const GDALColorTable& palette, float index) {
  const GDALColorEntry* entry = palette.GetColorEntry(static_cast<int>(index));
  return entry == nullptr ? 0.0F : static_cast<float>(entry->c1 + entry->c2 + entry->c3) / 3.0F;
}

class Decoder {
 public:
  explicit Decoder(const std::filesystem::path& path) : path_(path) {
    data_.reset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, kImageDrivers, nullptr, nullptr));
    if (data_ == nullptr || data_->GetRasterCount() < 1) refuse("a picture that can't be decoded");
    image_.width = static_cast<std::size_t>(data_->GetRasterXSize());
    image_.height = static_cast<std::size_t>(data_->GetRasterYSize());
    if (image_.width > kMostCells || image_.height > kMostCells / image_.width) {
      throw DataError(DataCode::size, path_.string(), "",
                      std::to_string(image_.width) + " by " + std::to_string(image_.height) + " pixels",
                      "at most " + std::to_string(kMostCells));
    }
  }

  GreyImage decode() {
    image_.brightness.assign(image_.width * image_.height, 0.0F);
    const int bands = data_->GetRasterCount();
    if (bands == 2 || bands == 4) image_.is_transparent.resize(image_.brightness.size());
    for (std::size_t row = 0; row < image_.height; ++row) {
      decode_row(row, bands);
      // GDAL keeps what it has decoded, up to a 20th of the machine's memory. Whole rows go, of all bands: one that is
      // wanted again is decoded from the first on.
      if (row % kRowsKept == kRowsKept - 1)
        for (int k = 1; k <= bands; ++k) data_->GetRasterBand(k)->FlushCache();
    }
    return std::move(image_);
  }

 private:
  void decode_row(std::size_t row, int bands) {
    const int colours = bands >= 3 ? 3 : 1;
    float* const pixels = image_.brightness.data() + row * image_.width;
    for (int k = 1; k <= colours; ++k) add_colour(*data_->GetRasterBand(k), row, pixels);
    for (std::size_t x = 0; x < image_.width; ++x) pixels[x] /= static_cast<float>(colours);
    if (!image_.is_transparent.empty()) read_alpha(*data_->GetRasterBand(bands), row);
  }

  const std::vector<float>& row_of(GDALRasterBand& band, std::size_t row) {
    row_.resize(image_.width);
    const int width = static_cast<int>(image_.width);
    if (band.RasterIO(GF_Read, 0, static_cast<int>(row), width, 1, row_.data(), width, 1, GDT_Float32, 0, 0) !=
        CE_None) {
      refuse("a picture that breaks off");
    }
    return row_;
  }

  void add_colour(GDALRasterBand& band, std::size_t row, float* pixels) {
    const GDALColorTable* palette = band.GetColorTable();
    const auto scale = static_cast<float>(255.0 / (band.GetRasterDataType() == GDT_UInt16 ? 65535.0 : 255.0));
    const std::vector<float>& values = row_of(band, row);
    for (std::size_t x = 0; x < values.size(); ++x) {
      pixels[x] += palette != nullptr ? brightness_of(*palette, values[x]) : scale * values[x];
    }
  }

  void read_alpha(GDALRasterBand& band, std::size_t row) {
    const std::vector<float>& alpha = row_of(band, row);
    for (std::size_t x = 0; x < alpha.size(); ++x) image_.is_transparent[row * image_.width + x] = alpha[x] <= 0.0F;
  }

  [[noreturn]] void refuse(const std::string& found) {
    const std::string words = complaints_.take_failure();
    throw DataError(DataCode::image, path_.string(), "", words.empty() ? found : words,
                    "a PGM, PNG, BMP or JPEG picture");
  }

  std::filesystem::path path_;
  GdalComplaints complaints_;
  std::unique_ptr<GDALDataset> data_;
  GreyImage image_;
  std::vector<float> row_;
};

}  // namespace

GreyImage read_gdal_image(const std::filesystem::path& path) {
  register_gdal_once();
  return Decoder(path).decode();
}

}  // namespace exactvo::datasets
