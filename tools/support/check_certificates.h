// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The file of proofs of a check: JSON lines for `exactvo audit --certificate`, one for each pair of motions whose
/// boxes meet, and a summary.

#include <string>
#include <vector>

#include "exactvo/datasets/atomic_file.h"
#include "support/checked_file.h"
#include "support/json_layout.h"

namespace exactvo::tools {

class CheckCertificates {
 public:
  CheckCertificates(const std::string& path, const CheckedFile& asked, const std::vector<geometry::RigidBody>& bodies);

  void add(const geometry::MetPair& pair);
  /// Writes the file, and returns how many proofs are in it, in words.
  std::string finish();

 private:
  void add_to_obstacle(const geometry::MetPair& pair, const geometry::RigidBody& body,
                       const formation::SceneObstacle& obstacle);
  void add_to_body(const geometry::MetPair& pair, const geometry::RigidBody& body, const geometry::RigidBody& other);
  void write(const std::string& certificate);
  void write_none(const geometry::MetPair& pair, bool touches);

  datasets::AtomicFile out_;
  const CheckedFile& asked_;
  const std::vector<geometry::RigidBody>& bodies_;
  std::vector<std::string> obstacles_;  ///< as proofs name them; empty: not yet named
  std::size_t count_ = 0, touching_ = 0, unproven_ = 0;
};

}  // namespace exactvo::tools
