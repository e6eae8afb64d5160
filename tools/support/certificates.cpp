// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/containment.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace {

constexpr const char* kFirstWords[] = {"half-plane-certificate ", "containment-certificate "};

std::string text_of(const std::string& file) {
  if (file == "-") return {std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  // A folder opens; only reading it fails.
  if (!in || (in.peek() != std::ifstream::traits_type::eof() && !(text << in.rdbuf())) || in.bad())
    throw datasets::DataError(datasets::DataCode::file_unreadable, file, "", "no file that can be read",
                              "lines of certificates");
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") != std::string::npos) lines.push_back(line);
  }
  return lines;
}

bool begins_as_one(const std::string& text, std::size_t at) {
  return std::any_of(std::begin(kFirstWords), std::end(kFirstWords),
                     [&](const char* word) { return text.compare(at, std::strlen(word), word) == 0; });
}

/// A certificate has no character that JSON escapes.
std::vector<std::string> strings_of_json(const std::string& text) {
  std::vector<std::string> strings;
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 1))
    if (begins_as_one(text, at + 1)) strings.push_back(text.substr(at + 1, text.find('"', at + 1) - at - 1));
  return strings;
}

std::string claim_words(const vo::HalfPlaneClaim& c) {
  const geometry::HalfPlane& h = c.half_plane;
  return fmt::format("{:+.6g} v_x {:+.6g} v_y >= {:.6g} m/s, robot at ({:.6g}, {:.6g}), radius {:.6g} m, {:g} s",
                     h.normal.x, h.normal.y, h.offset, c.position.x, c.position.y, c.radius, c.time_horizon);
}

std::string claim_words(const vo::Containment& c) {
  return fmt::format("an ellipse round ({:.6g}, {:.6g}) contains {} points", c.ellipse.center.x, c.ellipse.center.y,
                     c.points.size());
}

JudgedCertificate judged_as(vo::Verdict verdict, std::string claim) {
  return {name(verdict), std::move(claim), verdict == vo::Verdict::valid};
}

JudgedCertificate judge(const std::string& text) {
  if (const auto c = vo::read_certificate(text)) return judged_as(check(*c), claim_words(c->claim));
  if (const auto c = vo::read_containment(text)) return judged_as(check(*c), claim_words(*c));
  return {"not a certificate", "", false};
}

std::size_t count_valid(const std::vector<JudgedCertificate>& judged) {
  std::size_t valid = 0;
  for (const JudgedCertificate& j : judged) valid += j.valid ? 1 : 0;
  return valid;
}

}  // namespace

std::vector<JudgedCertificate> judge_certificates_in(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool json = first != std::string::npos && (text[first] == '{' || text[first] == '[');
  std::vector<JudgedCertificate> judged;
  for (const std::string& one : json ? strings_of_json(text) : lines_of(text)) judged.push_back(judge(one));
  return judged;
}

std::vector<JudgedCertificate> judge_certificates(const std::string& file) {
  std::vector<JudgedCertificate> judged = judge_certificates_in(text_of(file));
  if (judged.empty()) throw UsageError("--certificate", file + ": no certificate", "a certificate a line");
  return judged;
}

std::string to_json(const std::vector<JudgedCertificate>& judged) {
  std::string verdicts;
  for (const JudgedCertificate& j : judged)
    verdicts += fmt::format("{}\"{}\"", verdicts.empty() ? "" : ", ", j.verdict);
  return fmt::format("{{\"certificates\": {}, \"valid\": {}, \"verdicts\": [{}]}}\n", judged.size(),
                     count_valid(judged), verdicts);
}

std::string in_words(const std::vector<JudgedCertificate>& judged) {
  std::string text;
  for (std::size_t k = 0; k < judged.size(); ++k) {
    text += fmt::format("{}: {}", k + 1, judged[k].verdict);
    if (!judged[k].claim.empty()) text += "; " + judged[k].claim;
    text += "\n";
  }
  return text + fmt::format("{} {}, {} valid\n", judged.size(), judged.size() == 1 ? "certificate" : "certificates",
                            count_valid(judged));
}

}  // namespace exactvo::tools
