// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Certificates that moving bodies stay clear, as JSON: two bodies with their motions (straight: "from" and "to"; on a
/// curve: "basis", "start", "end" and "points" of a geometry::CurvedMotion; where one turns, both with "from", "until",
/// "velocity" and "turn" of a geometry::TurningMotion), or one and an obstacle, and the separations that prove it
/// (geometry/motion_certificate.h). docs/guide/check.md has the format.
///
/// See also: certificates.h checks whole files.

#include <optional>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/turning_motions.h"
#include "support/certificates.h"
#include "support/json_layout.h"

namespace exactvo::tools {

/// One motion of a body.
struct BodyInMotion {
  geometry::Motion motion;
  const geometry::RigidBody* body = nullptr;
};

OrderedJson certificate_json(const geometry::MotionCertificate& certificate, const BodyInMotion& a,
                             const BodyInMotion& b);
OrderedJson certificate_json(const geometry::MotionCertificate& certificate, const BodyInMotion& a,
                             const formation::SceneObstacle& obstacle);

/// The same for a body that drives and turns.
OrderedJson certificate_json(const geometry::MotionCertificate& certificate, const geometry::TurningMotion& motion,
                             const geometry::RigidBody& body, const formation::SceneObstacle& obstacle);
OrderedJson certificate_json(const geometry::MotionCertificate& certificate, const geometry::TurningMotion& a,
                             const geometry::RigidBody& body_a, const geometry::TurningMotion& b,
                             const geometry::RigidBody& body_b);

/// Whether an object claims to be one.
bool is_motion_certificate(const OrderedJson& certificate);

/// The verdict: "valid", "not proven", "not a certificate". REQUIRES: is_motion_certificate(certificate).
CheckedCertificate check_motion_certificate(const OrderedJson& certificate);

}  // namespace exactvo::tools
