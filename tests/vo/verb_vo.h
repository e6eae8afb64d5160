// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The verb `vo` as a user runs it, for the tests of what it prints.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "exactvo/vo/certificate.h"
#include "tools/run_program.h"

namespace exactvo::test {

using nlohmann::json;

inline const std::string kSquare = "POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))";
inline const std::string kCourtyard = "'POLYGON((0 0,10 0,10 10,0 10,0 0),(2 2,2 8,8 8,8 2,2 2))'";
inline const std::string kCorner = "'POLYGON((0 0,10 0,10 1,1 1,1 10,0 10,0 0))'";

inline json json_of(const std::string& arguments) {
  const Outcome run = Workplace().run("vo " + arguments + " --json");
  EXPECT_EQ(run.status, 0) << run.err;
  return json::parse(run.out);
}

inline std::string words_of(const std::string& arguments) {
  const Outcome run = Workplace().run("vo " + arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  return run.out;
}

/// Whether the certificate is valid and of the half-plane beside it.
inline void expect_proven(const json& cone) {
  const auto certificate = vo::read_certificate(cone.at("certificate").at("text"));
  ASSERT_TRUE(certificate);
  EXPECT_EQ(check(*certificate), vo::Verdict::valid);
  EXPECT_EQ(certificate->claim.half_plane.offset, cone.at("half_plane").at("offset").get<double>());
  EXPECT_EQ(certificate->claim.half_plane.normal.x, cone.at("half_plane").at("normal")[0].get<double>());
}

}  // namespace exactvo::test
