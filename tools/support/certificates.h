// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Certificates of half-planes and of containment as text, and of routes (route_certificates.h) and motions
/// (motion_certificates.h) as JSON, checked by the checkers of vo/certificate.h, vo/containment.h,
/// geometry/route_certificate.h and geometry/motion_certificate.h, which share nothing with what makes them.

#include <cstddef>
#include <string>
#include <vector>

namespace exactvo::tools {

struct CheckedCertificate {
  std::string verdict;  ///< vo::name(Verdict), "not a certificate", "unreadable JSON"; of a route RouteChecker's
  std::string claim;    ///< what is claimed, rounded for people; empty where it is none
  bool valid = false;
};

struct CheckedCertificates {
  std::vector<CheckedCertificate> all;  ///< in order
  std::size_t none = 0;                 ///< places of JSON that say that there is none: "certificate": null
  bool is_summed = false;               ///< a "summary" of JSON lines says how many there are, which may be none
};

/// Every certificate of a file, or of stdin where its name is "-". Its text may be JSON, JSON lines or plain lines: one
/// a line, where blank lines do not count and any other line is "not a certificate". Of JSON (first letter { or [) the
/// text of every `certificate`, whatever it begins with, and every other string that begins as one; JSON that cannot be
/// read is one that is not valid. What stands next to a certificate is not looked at. Throws DataError where it can't
/// be read, and where neither a certificate nor a place that says there is none nor a summary is in it: no line begins
/// as one, no JSON has any.
CheckedCertificates check_certificates(const std::string& file);

std::string to_json(const CheckedCertificates& checked);
std::string in_words(const CheckedCertificates& checked);

}  // namespace exactvo::tools
