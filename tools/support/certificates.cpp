// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/certificates.h"

#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#include "exactvo/datasets/data_error.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace {

constexpr const char* kFirstWord = "half-plane-certificate ";

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

/// A certificate has no character that JSON escapes.
std::vector<std::string> strings_of_json(const std::string& text) {
  std::vector<std::string> strings;
  const std::string start = std::string("\"") + kFirstWord;
  for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at + 1))
    strings.push_back(text.substr(at + 1, text.find('"', at + 1) - at - 1));
  return strings;
}

JudgedCertificate judge(const std::string& text) {
  JudgedCertificate judged{vo::read_certificate(text), "not a certificate"};
  if (judged.certificate) judged.verdict = name(check(*judged.certificate));
  return judged;
}

/// What was proven: the claim, rounded for people.
std::string claim_words(const vo::HalfPlaneClaim& c) {
  const geometry::HalfPlane& h = c.half_plane;
  return fmt::format("{:+.6g} v_x {:+.6g} v_y >= {:.6g} m/s, robot at ({:.6g}, {:.6g}), radius {:.6g} m, {:g} s",
                     h.normal.x, h.normal.y, h.offset, c.position.x, c.position.y, c.radius, c.time_horizon);
}

std::size_t count_valid(const std::vector<JudgedCertificate>& judged) {
  std::size_t valid = 0;
  for (const JudgedCertificate& j : judged) valid += j.valid() ? 1 : 0;
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
  if (judged.empty()) throw UsageError("--certificate", file + ": no certificate", "a half-plane certificate a line");
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
    if (judged[k].certificate) text += "; " + claim_words(judged[k].certificate->claim);
    text += "\n";
  }
  return text + fmt::format("{} certificates, {} valid\n", judged.size(), count_valid(judged));
}

}  // namespace exactvo::tools
