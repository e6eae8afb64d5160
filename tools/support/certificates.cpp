// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/minkowski.h"
#include "exactvo/geometry/support.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/containment.h"
#include "support/fields.h"
#include "support/route_certificates.h"
#include "support/unsigned_zero.h"
#include "support/usage.h"

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

/// What a certificate beside them is of.
constexpr const char* kHalfPlanes[] = {"half_plane", "contact_half_plane"};

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

/// The text of a `certificate`; nothing where there is none that could be read.
std::optional<std::string> text_in(const Json& certificate) {
  if (certificate.is_string()) return certificate.get<std::string>();
  if (!certificate.is_object()) return std::nullopt;
  const auto text = certificate.find("text");
  if (text == certificate.end() || !text->is_string()) return std::nullopt;
  return text->get<std::string>();
}

/// What `exactvo vo` takes; sums of such stay far from overflow.
bool is_within_reach(const geometry::ConvexShape& shape) {
  constexpr double kFarthest = 0x1p100;
  const geometry::GrownShape s{shape, {}, 0.0};
  const auto in_reach = [&](geometry::Vec2 n) { return geometry::support(s, n).h <= kFarthest; };
  return in_reach({1.0, 0.0}) && in_reach({-1.0, 0.0}) && in_reach({0.0, 1.0}) && in_reach({0.0, -1.0});
}

/// The ellipse that the obstacle beside a half-plane was proven to lie in.
std::optional<geometry::Ellipse> contained_in(const Json& object) {
  const auto taken = object.find("taken_as");
  if (taken == object.end() || !taken->is_object() || !taken->contains("certificate")) return std::nullopt;
  const auto text = text_in(taken->at("certificate"));
  const auto containment = text ? vo::read_containment(*text) : std::nullopt;
  return containment ? std::optional(containment->ellipse) : std::nullopt;
}

/// Whether an ellipse stands for the obstacle.
bool is_taken_as_ellipse(const Json& object) {
  const auto taken = object.find("taken_as");
  if (taken == object.end() || !taken->is_object()) return false;
  const auto what = taken->find("what");
  return contained_in(object) ||
         (what != taken->end() && (*what == "smallest ellipse" || *what == "trap-free ellipse"));
}

/// The shape that a member names; nothing where there is none that could be read, or that no velocity obstacle has.
std::optional<geometry::ConvexShape> shape_in(const Json& object, const char* key) {
  const auto member = object.find(key);
  if (member == object.end() || !member->is_string()) return std::nullopt;
  auto shape = vo::read_shape(member->get<std::string>());
  if (!shape || !geometry::is_valid(*shape) || !is_within_reach(*shape)) return std::nullopt;
  return shape;
}

/// Of what a half-plane's certificate beside `shape` must be: that, or its sum with a polygonal robot, which is made
/// again. Nothing where it names no obstacle that could be read.
std::optional<geometry::GrownShape> named_by(const Json& object, const vo::HalfPlaneClaim& claim) {
  const auto shape = shape_in(object, "shape");
  if (!shape) return std::nullopt;
  if (!object.contains("robot")) return geometry::GrownShape{*shape, claim.position, claim.radius};
  const auto robot = shape_in(object, "robot");
  const auto* polygon = robot ? std::get_if<geometry::ConvexPolygon>(&*robot) : nullptr;
  if (polygon == nullptr) return std::nullopt;
  return geometry::grown_by_polygon(*shape, *polygon, claim.position).shape;
}

/// Number by number.
bool is_of_another_obstacle(const vo::HalfPlaneClaim& claim, const Json& object) {
  if (!object.contains("shape")) return false;
  const auto named = named_by(object, claim);
  return !named || to_string(named->shape) != to_string(claim.shape) || named->radius != claim.radius;
}

/// Whether an ellipse that stands for the obstacle is not the one beside it, or none. Without a `shape`, of which a
/// sum could be, the certificate itself must be of it.
bool is_of_another_ellipse(const vo::HalfPlaneClaim& claim, const Json& object) {
  if (!is_taken_as_ellipse(object)) return false;
  const auto named = object.contains("shape") ? shape_in(object, "shape") : std::optional(claim.shape);
  const auto* of = named ? std::get_if<geometry::Ellipse>(&*named) : nullptr;
  const auto contained = contained_in(object);
  return of == nullptr || (contained && to_string(*of) != to_string(*contained)) ||
         is_of_another_obstacle(claim, object);
}

bool is_number(const Json& json, double x) {
  return json.is_number() && json.get<double>() == x;
}

/// Number by number: what `vo` prints reads back as the same doubles.
bool is_half_plane(const Json& json, const geometry::HalfPlane& h) {
  if (!json.is_object() || !json.contains("normal") || !json.contains("offset")) return false;
  const Json& normal = json["normal"];
  return normal.is_array() && normal.size() == 2 && is_number(normal[0], h.normal.x) &&
         is_number(normal[1], h.normal.y) && is_number(json["offset"], h.offset);
}

/// Whether a half-plane stands beside the certificate that is not its own (of a containment none is).
bool is_of_another_half_plane(const std::optional<vo::Certificate>& c, const Json& object) {
  return std::any_of(std::begin(kHalfPlanes), std::end(kHalfPlanes), [&](const char* key) {
    const auto beside = object.find(key);
    if (beside == object.end() || beside->is_null()) return false;
    return !c || !is_half_plane(*beside, c->claim.half_plane);
  });
}

JudgedCertificate judge_beside(const std::string& text, const Json& object) {
  JudgedCertificate judged = judge(text);
  if (!judged.valid) return judged;
  const auto c = vo::read_certificate(text);
  if (c && is_of_another_ellipse(c->claim, object)) return {"of another ellipse", judged.claim, false};
  if (c && is_of_another_obstacle(c->claim, object)) return {"of another obstacle", judged.claim, false};
  if (is_of_another_half_plane(c, object)) return {"of another half-plane", judged.claim, false};
  return judged;
}

/// The certificates of one JSON value or of several lines of JSON, in order.
class TreeJudge {
 public:
  void judge(const std::string& text) {
    if (const auto json = parsed(text)) {
      walk(*json);
    } else {
      judged_.all.push_back({"unreadable JSON", "", false});
    }
  }
  JudgedCertificates judged() && { return std::move(judged_); }

 private:
  void walk(const Json& value) {
    if (value.is_string() && begins_as_one(value.get_ref<const std::string&>()))
      judged_.all.push_back(tools::judge(value.get<std::string>()));
    if (value.is_array())
      for (const Json& item : value) walk(item);
    if (!value.is_object()) return;
    if (RouteJudge::is_one(value)) return judged_.all.push_back(routes_.judge(value, nullptr));
    if (RouteJudge::lacks_one(value)) return judged_.all.push_back({"no certificate", "", false});
    for (const auto& [key, member] : value.items()) {
      if (key == "certificate") {
        add(member, value);
      } else {
        walk(member);
      }
    }
  }

  void add(const Json& certificate, const Json& object) {
    if (certificate.is_null()) {
      ++judged_.none;
    } else if (RouteJudge::is_one(certificate)) {
      judged_.all.push_back(routes_.judge(certificate, object));
    } else {
      judged_.all.push_back(judge_beside(text_in(certificate).value_or(""), object));
    }
  }

  RouteJudge routes_;
  JudgedCertificates judged_;
};

/// Whether the text is a JSON value a line, several of them.
bool is_json_lines(const std::string& text) {
  const std::vector<std::string> lines = lines_of(text);
  return lines.size() > 1 && !Json::accept(text) && Json::accept(lines.front());
}

JudgedCertificates judge_json(const std::string& text) {
  TreeJudge judge;
  if (is_json_lines(text)) {
    for (const std::string& line : lines_of(text)) judge.judge(line);
  } else {
    judge.judge(text);
  }
  return std::move(judge).judged();
}

JudgedCertificates judge_lines(const std::string& text) {
  JudgedCertificates judged;
  for (const std::string& one : lines_of(text)) judged.all.push_back(judge(one));
  return judged;
}

bool is_json(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && (text[first] == '{' || text[first] == '[');
}

/// A picture, say, has none; of a spoilt certificate the first word is most often left.
bool has_a_line_of_one(const std::string& text) {
  const std::vector<std::string> lines = lines_of(text);
  return std::any_of(lines.begin(), lines.end(), begins_as_one);
}

auto count_valid(const JudgedCertificates& judged) {
  return std::count_if(judged.all.begin(), judged.all.end(), [](const JudgedCertificate& j) { return j.valid; });
}

}  // namespace

JudgedCertificates judge_certificates_in(const std::string& text) {
  return is_json(text) ? judge_json(text) : judge_lines(text);
}

JudgedCertificates judge_certificates(const std::string& file) {
  const std::string whole = datasets::read_file_or_input(file), text(without_mark(whole));
  JudgedCertificates judged = judge_certificates_in(text);
  const bool is_empty = judged.all.empty() && judged.none == 0;
  if (is_empty || (!is_json(text) && !has_a_line_of_one(text)))
    throw UsageError("--certificate", file + ": no certificate", "a certificate a line");
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
  const std::string none = judged.none > 0 ? fmt::format(", {} none", judged.none) : "";
  return text + fmt::format("{} {}, {} valid{}\n", judged.all.size(),
                            judged.all.size() == 1 ? "certificate" : "certificates", count_valid(judged), none);
}

}  // namespace exactvo::tools
