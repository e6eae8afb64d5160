// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/data_error.h"
#include "gdal/gdal_session.h"
#include "readers/grey_image.h"
#include "readers/grid.h"

namespace exactvo::datasets {
namespace {

const char* const kDrivers[] = {"PNG", "BMP", "JPEG", nullptr};

double brightest_of(GDALRasterBand& band) {
  return band.GetRasterDataType() == GDT_UInt16 ? 65535.0 : 255.0;
}

/// A palette's colour as one brightness.
float brightness_of(const GDALColorTable& palette, float index) {
  const GDALColorEntry* entry = palette.GetColorEntry(static_cast<int>(index));
  return entry == nullptr ? 0.0F : static_cast<float>(entry->c1 + entry->c2 + entry->c3) / 3.0F;
}

class Decoder {
 public:
  explicit Decoder(const std::filesystem::path& path) : path_(path) {
    data_.reset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, kDrivers, nullptr, nullptr));
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
    const int colours = bands >= 3 ? 3 : 1;
    for (int k = 1; k <= colours; ++k) add_colour(*data_->GetRasterBand(k));
    for (float& pixel : image_.brightness) pixel /= static_cast<float>(colours);
    if (bands == 2 || bands == 4) read_alpha(*data_->GetRasterBand(bands));
    return std::move(image_);
  }

 private:
  std::vector<float> pixels_of(GDALRasterBand& band) {
    std::vector<float> pixels(image_.brightness.size());
    const int width = static_cast<int>(image_.width);
    const int height = static_cast<int>(image_.height);
    if (band.RasterIO(GF_Read, 0, 0, width, height, pixels.data(), width, height, GDT_Float32, 0, 0) != CE_None) {
      refuse("a picture that breaks off");
    }
    return pixels;
  }

  void add_colour(GDALRasterBand& band) {
    const GDALColorTable* palette = band.GetColorTable();
    const auto scale = static_cast<float>(255.0 / brightest_of(band));
    const std::vector<float> pixels = pixels_of(band);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      image_.brightness[i] += palette != nullptr ? brightness_of(*palette, pixels[i]) : scale * pixels[i];
    }
  }

  void read_alpha(GDALRasterBand& band) {
    const std::vector<float> alpha = pixels_of(band);
    image_.is_transparent.resize(alpha.size());
    for (std::size_t i = 0; i < alpha.size(); ++i) image_.is_transparent[i] = alpha[i] <= 0.0F;
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
};

}  // namespace

GreyImage read_gdal_image(const std::filesystem::path& path) {
  register_gdal_once();
  return Decoder(path).decode();
}

}  // namespace exactvo::datasets
