// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/check_certificates.h"

#include <fmt/format.h>

#include <algorithm>

#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/turning_pairs.h"
#include "support/motion_certificates.h"

namespace exactvo::tools {

using geometry::Encounter;
using geometry::MetPair;
using geometry::RigidBody;

namespace {

geometry::TurningMotion arc_of(const geometry::Motion& piece, const geometry::Turned& turned) {
  return geometry::turning_motion(std::get<geometry::StraightMotion>(piece), turned);
}

}  // namespace

CheckCertificates::CheckCertificates(const std::string& path, const CheckedFile& asked,
                                     const std::vector<RigidBody>& bodies)
    : out_(path, datasets::MissingFolder::is_made, datasets::Unfinished::goes, datasets::Pipe::is_written),
      asked_(asked),
      bodies_(bodies),
      obstacles_(asked.obstacles.size()) {}

void CheckCertificates::add(const MetPair& pair) {
  const RigidBody body = turned_body(bodies_[pair.body], pair.turned.from);
  if (!pair.with_obstacle) return add_to_body(pair, body, turned_body(bodies_[pair.other], pair.other_turned.from));
  const formation::SceneObstacle& obstacle = asked_.obstacles[pair.other];
  // An obstacle that is a disc is a body at rest.
  if (obstacle.disc) return add_to_body(pair, body, geometry::disc_body(obstacle.disc->radius));
  add_to_obstacle(pair, body, obstacle);
}

void CheckCertificates::add_to_obstacle(const MetPair& pair, const RigidBody& body,
                                        const formation::SceneObstacle& obstacle) {
  std::string& name = obstacles_[pair.other];
  if (name.empty()) name = obstacle_text(obstacle);
  if (pair.turned.by != 0.0) {
    const geometry::TurningMotion arc = arc_of(pair.motion, pair.turned);
    if (const auto proof = geometry::certify(arc, body, obstacle.shape))
      return write(certificate_text(*proof, arc, body, name));
    return write_none(pair, encounter(arc, body, obstacle.shape) != Encounter::clear);
  }
  if (const auto proof = geometry::certify(pair.motion, body, obstacle.shape))
    return write(certificate_text(*proof, {pair.motion, &body}, name));
  write_none(pair, encounter(pair.motion, body, obstacle.shape) != Encounter::clear);
}

void CheckCertificates::add_to_body(const MetPair& pair, const RigidBody& body, const RigidBody& other) {
  if (pair.turned.by != 0.0 || pair.other_turned.by != 0.0) {
    const geometry::TurningMotion a = arc_of(pair.motion, pair.turned),
                                  b = arc_of(pair.other_motion, pair.other_turned);
    if (const auto proof = geometry::certify(a, body, b, other))
      return write(certificate_text(*proof, a, body, b, other));
    const geometry::TurningVerdict found = examine(a, body, b, other);
    return write_none(pair, found.verdict.encounter != Encounter::clear && !found.is_open);
  }
  if (const auto proof = geometry::certify(pair.motion, body, pair.other_motion, other))
    return write(certificate_text(*proof, {pair.motion, &body}, {pair.other_motion, &other}));
  write_none(pair, encounter(pair.motion, body, pair.other_motion, other) != Encounter::clear);
}

std::string CheckCertificates::finish() {
  out_.write(json_line(
      {{"summary", {{"certificates", count_}, {"without", touching_ + unproven_}, {"unproven", unproven_}}}}));
  out_.commit();
  std::string words = geometry::counted(count_, "certificate") + " for motions that come near and stay clear";
  if (touching_ > 0) words += fmt::format(", none for {} that {}", touching_, touching_ == 1 ? "touches" : "touch");
  if (unproven_ > 0) words += fmt::format(", none for {} too near for a proof", unproven_);
  return words;
}

void CheckCertificates::write(const std::string& certificate) {
  ++count_;
  out_.write("{\"certificate\":" + certificate + "}\n");
}

void CheckCertificates::write_none(const MetPair& pair, bool touches) {
  ++(touches ? touching_ : unproven_);
  out_.write(json_line({{"certificate", nullptr},
                        {"why", touches ? "touches" : "too near"},
                        {"from", pair.with_obstacle ? start_of(pair.motion)
                                                    : std::max(start_of(pair.motion), start_of(pair.other_motion))},
                        {"body", asked_.file.agents[pair.body]},
                        {pair.with_obstacle ? "obstacle" : "other",
                         pair.with_obstacle ? asked_.obstacles[pair.other].id : asked_.file.agents[pair.other]}}));
}

}  // namespace exactvo::tools
