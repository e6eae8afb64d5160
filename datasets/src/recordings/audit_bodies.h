// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Point (2) of an audit: bodies contain what they stand for, and every robot has some for every obstacle.

#include <vector>

#include "recordings/audit_rows.h"
#include "recordings/audit_scene.h"
#include "recordings/audit_tally.h"

namespace exactvo::datasets {

class BodyAudit {
 public:
  /// Keeps references. REQUIRES: `places` of all rows.
  BodyAudit(const RecordingFile& file, const std::vector<RationalObstacle>& obstacles, const PlacesInRows& places,
            AuditTally& tally);

  void check();

 private:
  /// Edges of one owner that lie in the body.
  struct Covered {
    std::size_t owner;
    std::vector<bool> edges;
    bool any = false;
  };

  void check_body(std::size_t number);
  bool is_made_of_its_owner(const vo::Body& body) const;
  void check_outlooks();
  bool is_in_order(const formation::Outlook& outlook, const formation::Outlook* before) const;
  std::vector<bool> covered_by(const formation::Outlook& outlook) const;

  const RecordingFile& file_;
  const std::vector<RationalObstacle>& obstacles_;
  const PlacesInRows& places_;
  std::vector<std::vector<Covered>> covered_;  ///< of each body; of enclosures only
  AuditTally& tally_;
};

}  // namespace exactvo::datasets
