// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Half-plane certificates as text, judged by the checker of vo/certificate.h, which shares nothing with what makes
/// them.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/vo/certificate.h"

namespace exactvo::tools {

struct JudgedCertificate {
  std::optional<vo::Certificate> certificate;  ///< nothing where the text is none
  std::string verdict;                         ///< vo::name(Verdict), or "not a certificate"
  bool valid() const { return certificate && check(*certificate) == vo::Verdict::valid; }
};

/// Every certificate of a text: one a line, where blank lines do not count and any other line is "not a certificate";
/// of JSON (first letter { or [) every string that begins as one. In order.
std::vector<JudgedCertificate> judge_certificates_in(const std::string& text);

/// The same of a file, or of stdin where its name is "-". Throws DataError where it can't be read, UsageError where
/// nothing is in it.
std::vector<JudgedCertificate> judge_certificates(const std::string& file);

std::string to_json(const std::vector<JudgedCertificate>& judged);
std::string in_words(const std::vector<JudgedCertificate>& judged);

}  // namespace exactvo::tools
