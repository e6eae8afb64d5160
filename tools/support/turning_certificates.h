// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Certificates that a body that drives and turns stays clear of an obstacle (geometry/turning_motions.h), as JSON: the
/// kind of motion_certificates.h, which checks them, with "until", "velocity" and "turn" in "a".

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/turning_motions.h"
#include "support/json_layout.h"

namespace exactvo::tools {

OrderedJson turning_certificate_json(const geometry::MotionCertificate& certificate,
                                     const geometry::TurningMotion& motion, const geometry::RigidBody& body,
                                     const formation::SceneObstacle& obstacle);

}  // namespace exactvo::tools
