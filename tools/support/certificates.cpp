// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
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

bool begins_as_one(const std::string& text) {
  return std::any_of(std::begin(kFirstWords), std::end(kFirstWords),
                     [&](const char* word) { return text.compare(0, std::strlen(word), word) == 0; });
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

// --- In JSON ---

using Json = nlohmann::ordered_json;

/// What `exactvo vo` prints is far from so deep, and what walks the tree calls itself.
constexpr int kDeepest = 100;

/// Nothing where it is none, or too deep.
std::optional<Json> parsed(const std::string& text) {
  bool too_deep = false;
  const auto shallow = [&](int depth, Json::parse_event_t, const Json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  Json json = Json::parse(text, shallow, false);
  if (too_deep || json.is_discarded()) return std::nullopt;
  return json;
}

/// The text of a `certificate`; nothing where there is none that could be read.
std::optional<std::string> text_in(const Json& certificate) {
  if (certificate.is_string()) return certificate.get<std::string>();
  if (!certificate.is_object()) return std::nullopt;
  const auto text = certificate.find("text");
  if (text == certificate.end() || !text->is_string()) return std::nullopt;
  return text->get<std::string>();
}

/// The ellipse that the obstacle beside a half-plane was proven to lie in.
std::optional<geometry::Ellipse> contained_in(const Json& object) {
  const auto taken = object.find("taken_as");
  if (taken == object.end() || !taken->is_object() || !taken->contains("certificate")) return std::nullopt;
  const auto text = text_in(taken->at("certificate"));
  const auto containment = text ? vo::read_containment(*text) : std::nullopt;
  return containment ? std::optional(containment->ellipse) : std::nullopt;
}

/// Whether the half-plane is of an ellipse, and not of this one.
bool is_of_another(const std::string& text, const geometry::Ellipse& ellipse) {
  const auto c = vo::read_certificate(text);
  const auto* of = c ? std::get_if<geometry::Ellipse>(&c->claim.shape) : nullptr;
  const auto numbers = [](const geometry::Ellipse& e) {
    return std::array{e.center.x, e.center.y, e.l11, e.l21, e.l22};
  };
  return of && numbers(*of) != numbers(ellipse);
}

JudgedCertificate judge_beside(const std::string& text, const std::optional<geometry::Ellipse>& ellipse) {
  JudgedCertificate judged = judge(text);
  if (judged.valid && ellipse && is_of_another(text, *ellipse)) {
    judged.verdict = "of another ellipse";
    judged.valid = false;
  }
  return judged;
}

void judge_member(const Json& certificate, const Json& object, JudgedCertificates& judged) {
  if (certificate.is_null()) {
    ++judged.none;
  } else {
    judged.all.push_back(judge_beside(text_in(certificate).value_or(""), contained_in(object)));
  }
}

void judge_tree(const Json& value, JudgedCertificates& judged) {
  if (value.is_string() && begins_as_one(value.get_ref<const std::string&>()))
    judged.all.push_back(judge(value.get<std::string>()));
  if (value.is_array())
    for (const Json& item : value) judge_tree(item, judged);
  if (!value.is_object()) return;
  for (const auto& [key, member] : value.items()) {
    if (key == "certificate") {
      judge_member(member, value, judged);
    } else {
      judge_tree(member, judged);
    }
  }
}

JudgedCertificates judge_json(const std::string& text) {
  JudgedCertificates judged;
  if (const auto json = parsed(text)) {
    judge_tree(*json, judged);
  } else {
    judged.all.push_back({"unreadable JSON", "", false});
  }
  return judged;
}

JudgedCertificates judge_lines(const std::string& text) {
  JudgedCertificates judged;
  for (const std::string& one : lines_of(text)) judged.all.push_back(judge(one));
  return judged;
}

auto count_valid(const JudgedCertificates& judged) {
  return std::count_if(judged.all.begin(), judged.all.end(), [](const JudgedCertificate& j) { return j.valid; });
}

}  // namespace

JudgedCertificates judge_certificates_in(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool json = first != std::string::npos && (text[first] == '{' || text[first] == '[');
  return json ? judge_json(text) : judge_lines(text);
}

JudgedCertificates judge_certificates(const std::string& file) {
  JudgedCertificates judged = judge_certificates_in(text_of(file));
  if (judged.all.empty()) throw UsageError("--certificate", file + ": no certificate", "a certificate a line");
  return judged;
}

std::string to_json(const JudgedCertificates& judged) {
  std::string verdicts;
  for (const JudgedCertificate& j : judged.all)
    verdicts += fmt::format("{}\"{}\"", verdicts.empty() ? "" : ", ", j.verdict);
  return fmt::format("{{\"certificates\": {}, \"valid\": {}, \"none\": {}, \"verdicts\": [{}]}}\n", judged.all.size(),
                     count_valid(judged), judged.none, verdicts);
}

std::string in_words(const JudgedCertificates& judged) {
  std::string text;
  for (std::size_t k = 0; k < judged.all.size(); ++k) {
    text += fmt::format("{}: {}", k + 1, judged.all[k].verdict);
    if (!judged.all[k].claim.empty()) text += "; " + judged.all[k].claim;
    text += "\n";
  }
  const std::string none = judged.none > 0 ? fmt::format(", {} null", judged.none) : "";
  return text + fmt::format("{} {}, {} valid{}\n", judged.all.size(),
                            judged.all.size() == 1 ? "certificate" : "certificates", count_valid(judged), none);
}

}  // namespace exactvo::tools
