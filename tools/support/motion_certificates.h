// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Certificates that moving bodies stay clear, as JSON: two bodies with their motions (straight: "from" and "to"; on a
/// curve: "basis", "start", "end" and "points" of a geometry::CurvedMotion; where one turns, both with "from", "until",
/// "velocity" and "turn" of a geometry::TurningMotion), or one and an obstacle, and the separations that prove it
/// (geometry/motion_certificate.h). docs/guide/check.md has the format.
///
/// See also: certificates.h checks whole files.

#include <string>
#include <string_view>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/turning_motions.h"
#include "support/certificates.h"
#include "support/json_layout.h"

namespace exactvo::tools {

struct BodyInMotion {
  geometry::Motion motion;
  const geometry::RigidBody* body = nullptr;
};

/// An obstacle as a certificate names it.
std::string obstacle_text(const formation::SceneObstacle& obstacle);

/// The certificate as JSON on one line. `obstacle`: of obstacle_text.
std::string certificate_text(const geometry::MotionCertificate& certificate, const BodyInMotion& a,
                             const BodyInMotion& b);
std::string certificate_text(const geometry::MotionCertificate& certificate, const BodyInMotion& a,
                             std::string_view obstacle);

/// The same for a body that drives and turns.
std::string certificate_text(const geometry::MotionCertificate& certificate, const geometry::TurningMotion& motion,
                             const geometry::RigidBody& body, std::string_view obstacle);
std::string certificate_text(const geometry::MotionCertificate& certificate, const geometry::TurningMotion& a,
                             const geometry::RigidBody& body_a, const geometry::TurningMotion& b,
                             const geometry::RigidBody& body_b);

/// Whether an object claims to be one.
bool is_motion_certificate(const OrderedJson& certificate);

/// The verdict: "valid", "not proven", "not a certificate". REQUIRES: is_motion_certificate(certificate).
CheckedCertificate check_motion_certificate(const OrderedJson& certificate);

}  // namespace exactvo::tools
