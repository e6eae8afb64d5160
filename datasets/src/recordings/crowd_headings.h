// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

/// Where robots on wheels head, from where they headed at first and from their places: (1) of crowd/wheels.h, rounded.
class CrowdHeadings {
 public:
  /// Known only where every step is a row.
  explicit CrowdHeadings(const CrowdRecordingHead& head) : head_(head) {
    if (head.every == 1) half_ = head.half_headings;
  }
  bool has(std::size_t robot) const { return !half_.empty() && kind_of(robot).wheels; }
  void follow(const CrowdRow& row) {
    for (std::size_t i = 0; i < half_.size() && !before_.x.empty(); ++i) {
      if (!has(i)) continue;
      const double ahead = 2.0 * kind_of(i).wheels->reference / head_.position_step, x = row.x[i] - before_.x[i],
                   y = row.y[i] - before_.y[i];
      const geometry::Vec2 w = half_[i];
      half_[i] = normalized(geometry::Vec2{(ahead + x) * w.x + y * w.y, (ahead - x) * w.y + y * w.x});
    }
    if (!half_.empty()) before_ = row;
  }
  /// REQUIRES: has(robot).
  formation::OnWheels of(std::size_t robot) const {
    const geometry::Vec2 w = normalized(half_[robot]);
    return {{w.x * w.x - w.y * w.y, 2.0 * w.x * w.y}, {}};
  }
  /// What a picture shows of a robot's wheels, with the disc of its body. REQUIRES: has(robot).
  formation::DifferentialDrive drive(std::size_t robot) const {
    const CrowdKindRecord& kind = kind_of(robot);
    formation::DifferentialDrive drive;
    drive.wheel_separation = kind.wheels->wheel_separation;
    drive.max_wheel_speed = kind.max_speed;
    drive.reference = kind.wheels->reference;
    drive.body_radius = kind.body_radius;
    if (drive.body_radius == 0.0)  // the file does not say
      drive.body_radius = std::max(0.0, kind.radius - drive.reference - stray_of(drive, head_.time_step));
    return drive;
  }

 private:
  const CrowdKindRecord& kind_of(std::size_t robot) const { return head_.kinds[head_.kind_of[robot]]; }

  const CrowdRecordingHead& head_;
  std::vector<geometry::Vec2> half_;
  CrowdRow before_;
};

}  // namespace exactvo::datasets
