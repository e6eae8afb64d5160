// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Certificates as text, of half-planes and of containment, judged by the checkers of vo/certificate.h and
/// vo/containment.h, which share nothing with what makes them.

#include <string>
#include <vector>

namespace exactvo::tools {

struct JudgedCertificate {
  std::string verdict;  ///< vo::name(Verdict), or "not a certificate"
  std::string claim;    ///< what is claimed, rounded for people; empty where it is none
  bool valid = false;
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
