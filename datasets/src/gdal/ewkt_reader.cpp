// SPDX-License-Identifier: GPL-3.0-or-later
// Geometries that name their reference system, as PostGIS prints them (SRID=4326;POLYGON...), from whatever reader.
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "gdal/gdal_session.h"
#include "gdal/layer_plane.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

/// Takes nothing but rings and lines, for the look at all of them before one is brought to metres.
class RingTaker : public Collector {
 public:
  RingTaker(const Collector& out, std::function<void(const geometry::Ring&)> take)
      : Collector(out.file(), "", out.options()), take_(std::move(take)) {}

  void add(const RawGeometry& raw) override {
    for (const geometry::Ring& ring : raw.rings) take_(ring);
  }
  void pass_over(std::string, std::string) override {}
  void note(std::string, std::string) override {}
  void reference_system(int, const std::string&) override {}
  void reject(DataError) override {}

 private:
  std::function<void(const geometry::Ring&)> take_;
};

/// Brings geometries to metres and hands them on.
class PlacingCollector : public Collector {
 public:
  PlacingCollector(int srid, LayerPlane& plane, Collector& out)
      : Collector(out.file(), "", out.options()), system_(srid), plane_(plane), out_(out) {}

  void add(const RawGeometry& raw) override {
    RawGeometry placed = raw;
    placed.as_written = plane_.as_written(raw.rings);
    try {
      for (geometry::Ring& ring : placed.rings) plane_.bring_to_metres(ring, raw.place);
    } catch (const DataError& error) {
      return out_.reject(error);
    }
    out_.add(placed);
  }
  void pass_over(std::string place, std::string text) override { out_.pass_over(std::move(place), std::move(text)); }
  void note(std::string place, std::string text) override { out_.note(std::move(place), std::move(text)); }
  void reject(DataError error) override { out_.reject(std::move(error)); }
  void progress(double share) const override { out_.progress(share); }
  void reference_system(int srid, const std::string& place) override {
    if (srid != system_) throw other_system(srid, system_, file(), place);
  }

 private:
  int system_;
  LayerPlane& plane_;
  Collector& out_;
};

}  // namespace

void read_in_system(int srid, const std::function<void(Collector&)>& read, Collector& out) {
  register_gdal_once();
  GdalComplaints complaints;
  const std::filesystem::path path = out.file();
  const OGRSpatialReference system = system_of_srid(srid, out.file(), complaints);
  LayerPlane plane(path, out, complaints);
  plane.reset();
  LayerNumbers numbers;
  numbers.system = &system;
  numbers.reason = "by SRID=" + std::to_string(srid);
  numbers.is_perhaps_metres = false;
  numbers.for_each_ring = [&](const std::function<void(const geometry::Ring&)>& take) {
    RingTaker taker(out, take);
    read(taker);
  };
  const std::string words = plane.settle(numbers);
  if (!words.empty()) out.note("", words);
  PlacingCollector placing(srid, plane, out);
  read(placing);
  plane.note_extent();
}

}  // namespace exactvo::datasets
