// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Certificates of routes as JSON: a question, its answer, and the obstacles that both are about. Numbers are doubles,
/// written so that they read back as the same; a coordinate that is no double stands as a fraction beside its rounded
/// value. docs/guide/routes.md has the format; examples/check_route.py checks it without this program.
///
/// See also: certificates.h checks whole files, geometry/route_certificate.h decides.

#include <optional>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/route_certificate.h"
#include "support/certificates.h"
#include "support/json_layout.h"

namespace exactvo::tools {

/// "route", "separated" or "blocked".
const char* status_of(const geometry::RouteAnswer& answer);

/// [x, y], the rounded coordinates.
OrderedJson rounded_json(const std::vector<geometry::ExactPoint>& points);

/// `obstacles` null: those of an earlier certificate in the same file.
OrderedJson certificate_json(const geometry::RouteQuestion& question, const geometry::RouteAnswer& answer,
                             const std::vector<formation::SceneObstacle>* obstacles);

/// Checks the certificates of one file in order.
class RouteChecker {
 public:
  /// Whether an object claims to be one: it has a `kind` that is a status.
  static bool is_one(const OrderedJson& certificate);

  /// Whether an object answers a question of a route, by its `status`, and has no certificate for it.
  static bool lacks_one(const OrderedJson& object);

  /// REQUIRES: is_one(certificate).
  CheckedCertificate check_one(const OrderedJson& certificate);

 private:
  std::optional<std::vector<geometry::Obstacle>> obstacles_;  ///< of the last certificate that had any
};

}  // namespace exactvo::tools
