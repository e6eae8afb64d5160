// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Provenance as JSON, both ways.

#include "exactvo/datasets/provenance.h"
#include "json/json_text.h"

namespace exactvo::datasets {

template <>
inline constexpr bool kOnOneLine<InputFile> = true;
template <class Codec>
void members(Codec& json, For<Codec, InputFile>& input) {
  json.member("path", input.path).member("sha256", input.sha256);
}

template <class Codec>
void members(Codec& json, For<Codec, Provenance>& p) {
  json.member("version", p.version).member("commit", p.commit).member("compiler", p.compiler);
  json.member("build_type", p.build_type).member("cgal", p.cgal).member("gmp", p.gmp).member("gdal", p.gdal);
  json.member("seed", p.seed).member("command_line", p.command_line).member("inputs", p.inputs);
  json.member_if(!p.written_at.empty(), "written_at", p.written_at);
}

}  // namespace exactvo::datasets
