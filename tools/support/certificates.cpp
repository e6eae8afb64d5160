// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/containment.h"
#include "readers/line_reader.h"
#include "support/certificate_json.h"
#include "support/json_layout.h"
#include "support/motion_certificates.h"
#include "support/route_certificates.h"

namespace exactvo::tools {

namespace {

constexpr const char* kFirstWords[] = {"half-plane-certificate ", "containment-certificate "};

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
                     unsigned_zero(h.normal.x), unsigned_zero(h.normal.y), unsigned_zero(h.offset),
                     unsigned_zero(c.position.x), unsigned_zero(c.position.y), c.radius, c.time_horizon);
}

std::string claim_words(const vo::Containment& c) {
  return fmt::format("an ellipse round ({:.6g}, {:.6g}) m contains {}", c.ellipse.center.x, c.ellipse.center.y,
                     geometry::counted(c.points.size(), "point"));
}

CheckedCertificate checked_as(vo::Verdict verdict, std::string claim) {
  return {name(verdict), std::move(claim), verdict == vo::Verdict::valid};
}

CheckedCertificate check_one(const std::string& text) {
  if (const auto c = vo::read_certificate(text)) return checked_as(check(*c), claim_words(c->claim));
  if (const auto c = vo::read_containment(text)) return checked_as(check(*c), claim_words(*c));
  return {"not a certificate", "", false};
}

// --- In JSON ---

using Json = nlohmann::ordered_json;

/// What `exactvo vo` prints is far from so deep, and what walks the tree calls itself.
constexpr int kDeepest = 100;

/// Nothing where it is none, or too deep, or an object has a member twice: readers differ in which of the two counts.
std::optional<Json> parsed(const std::string& text) {
  bool refused = false;
  std::vector<std::set<std::string>> members;  // of the objects that are open
  const auto look = [&](int depth, Json::parse_event_t event, const Json& json) {
    using Event = Json::parse_event_t;
    refused = refused || depth > kDeepest;
    if (event == Event::object_start) members.emplace_back();
    if (event == Event::object_end && !members.empty()) members.pop_back();
    if (event == Event::key && !members.empty())
      refused = !members.back().insert(json.get_ref<const std::string&>()).second || refused;
    return !refused;
  };
  Json json = Json::parse(text, look, false);
  if (refused || json.is_discarded()) return std::nullopt;
  return json;
}

/// The text of a `certificate`; empty where there is none that could be read.
std::string text_in(const Json& certificate) {
  const Json* text = certificate.is_string() ? &certificate : member(certificate, "text");
  return text != nullptr && text->is_string() ? text->get<std::string>() : std::string();
}

/// The certificates of one JSON value or of several lines of JSON, in order.
class TreeChecker {
 public:
  void add(const std::string& text) {
    if (const auto json = parsed(text)) {
      walk(*json);
    } else {
      checked_.all.push_back({"unreadable JSON", "", false});
    }
  }
  CheckedCertificates checked() && { return std::move(checked_); }

 private:
  void walk(const Json& value) {
    if (value.is_string() && begins_as_one(value.get_ref<const std::string&>()))
      checked_.all.push_back(check_one(value.get<std::string>()));
    if (value.is_array())
      for (const Json& item : value) walk(item);
    if (!value.is_object()) return;
    if (RouteChecker::is_one(value)) return checked_.all.push_back(routes_.check_one(value));
    if (is_motion_certificate(value)) return checked_.all.push_back(check_motion_certificate(value));
    if (RouteChecker::lacks_one(value)) return checked_.all.push_back({"no certificate", "", false});
    for (const auto& [key, member] : value.items()) {
      if (key == "summary" && member.is_object() && member.contains("certificates")) checked_.is_summed = true;
      if (key == "certificate") {
        add(member);
      } else {
        walk(member);
      }
    }
  }

  void add(const Json& certificate) {
    if (certificate.is_null()) {
      ++checked_.none;
    } else if (RouteChecker::is_one(certificate)) {
      checked_.all.push_back(routes_.check_one(certificate));
    } else if (is_motion_certificate(certificate)) {
      checked_.all.push_back(check_motion_certificate(certificate));
    } else {
      checked_.all.push_back(check_one(text_in(certificate)));
    }
  }

  RouteChecker routes_;
  CheckedCertificates checked_;
};

/// A JSON value, or one a line, several of them.
CheckedCertificates checked_in_json(const std::string& text) {
  TreeChecker tree;
  const std::vector<std::string> lines = lines_of(text);
  const bool is_lines = lines.size() > 1 && !Json::accept(text) && Json::accept(lines.front());
  for (const std::string& one : is_lines ? lines : std::vector<std::string>{text}) tree.add(one);
  return std::move(tree).checked();
}

bool is_json(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && (text[first] == '{' || text[first] == '[');
}

auto count_valid(const CheckedCertificates& checked) {
  return std::count_if(checked.all.begin(), checked.all.end(), [](const CheckedCertificate& j) { return j.valid; });
}

}  // namespace

CheckedCertificates check_certificates(const std::string& file) {
  const std::string whole = datasets::read_file_or_input(file), text(datasets::without_mark(whole));
  const std::vector<std::string> lines = is_json(text) ? std::vector<std::string>() : lines_of(text);
  CheckedCertificates checked;
  if (is_json(text)) checked = checked_in_json(text);
  for (const std::string& line : lines) checked.all.push_back(check_one(line));
  const bool is_empty = checked.all.empty() && checked.none == 0 && !checked.is_summed;
  // A picture, say, has none; of a spoilt certificate the first word is most often left.
  if (is_empty || (!is_json(text) && std::none_of(lines.begin(), lines.end(), begins_as_one)))
    throw datasets::DataError(datasets::DataCode::format_unknown, datasets::name_of_input(file), "",
                              whole.empty() ? "an empty file" : "no certificate", "a certificate a line");
  return checked;
}

std::string to_json(const CheckedCertificates& checked) {
  std::string verdicts;
  for (const CheckedCertificate& j : checked.all)
    verdicts += fmt::format("{}\"{}\"", verdicts.empty() ? "" : ", ", j.verdict);
  return fmt::format("{{\"certificates\": {}, \"valid\": {}, \"none\": {}, \"verdicts\": [{}]}}\n", checked.all.size(),
                     count_valid(checked), checked.none, verdicts);
}

std::string in_words(const CheckedCertificates& checked) {
  std::string text;
  for (std::size_t k = 0; k < checked.all.size(); ++k) {
    text += fmt::format("{}: {}", k + 1, checked.all[k].verdict);
    if (!checked.all[k].claim.empty()) text += "; " + checked.all[k].claim;
    text += "\n";
  }
  const std::string none = checked.none > 0 ? fmt::format(", {} none", checked.none) : "";
  return text + fmt::format("{} {}, {} valid{}\n", checked.all.size(),
                            checked.all.size() == 1 ? "certificate" : "certificates", count_valid(checked), none);
}

}  // namespace exactvo::tools
