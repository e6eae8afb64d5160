// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/picture.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "batch/formats/features.h"
#include "exactvo/datasets/markup.h"
#include "exactvo/geometry/box.h"

namespace exactvo::datasets::batch {
namespace {

using geometry::Ring;
using geometry::Vec2;

constexpr double kSide = 160.0;  // px of a picture
constexpr double kMargin = 6.0;  // px
constexpr int kEllipsePoints = 48;
/// Facades of an obstacle of thousands would be a black blot.
constexpr std::size_t kMostFacadeEllipses = 60;

/// From metres to pixels, y up to y down, to a tenth of a pixel.
class View {
 public:
  explicit View(const std::vector<Ring>& rings) {
    geometry::Box box;
    for (const Ring& ring : rings)
      for (const Vec2 p : ring) box.add(p);
    middle_ = 0.5 * box.low + 0.5 * box.high;
    const double extent = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
    scale_ = extent > 0.0 && std::isfinite(extent) ? (kSide - 2.0 * kMargin) / extent : 1.0;
  }

  /// "x,y x,y ..."; points that fall on the one before them in tenths of a pixel are left out.
  std::string points(const Ring& ring) const {
    std::string text;
    long last_x = std::numeric_limits<long>::min();
    long last_y = last_x;
    for (const Vec2 p : ring) {
      const long x = std::lround(10.0 * (0.5 * kSide + scale_ * (p.x - middle_.x)));
      const long y = std::lround(10.0 * (0.5 * kSide - scale_ * (p.y - middle_.y)));
      if (x == last_x && y == last_y) continue;
      if (!text.empty()) text += ' ';
      append_tenths(text, x);
      text += ',';
      append_tenths(text, y);
      last_x = x;
      last_y = y;
    }
    return text;
  }

 private:
  static void append_tenths(std::string& text, long tenths) {
    char digits[24];
    const std::to_chars_result end =
        std::to_chars(digits, digits + sizeof digits, 0.1 * static_cast<double>(tenths), std::chars_format::fixed, 1);
    text.append(digits, end.ptr);
  }

  Vec2 middle_;
  double scale_ = 1.0;
};

std::string element(const View& view, const Ring& ring, const char* kind) {
  return std::string("<polygon class=\"") + kind + "\" points=\"" + view.points(ring) + "\"/>";
}

}  // namespace

std::string picture_of(const std::string& id, const geometry::ObstacleShapes& shapes) {
  const Ring smallest = outline_of(shapes.smallest_ellipse, kEllipsePoints);
  Ring free;
  if (shapes.trap_free.ellipse) free = outline_of(*shapes.trap_free.ellipse, kEllipsePoints);
  const View view({shapes.hull.vertices, smallest, free});
  std::string text = "<figure><svg viewBox=\"0 0 160 160\">";
  if (!free.empty()) text += element(view, free, "t");
  text += element(view, smallest, "e") + element(view, shapes.hull.vertices, "h");
  if (shapes.facade_ellipses.size() <= kMostFacadeEllipses) {
    for (const auto& e : shapes.facade_ellipses) text += element(view, outline_of(e.ellipse, 24), "f");
  }
  if (const auto* wall = std::get_if<geometry::Polyline>(&shapes.obstacle)) {
    text += "<polyline class=\"w\" points=\"" + view.points(wall->points) + "\"/>";
  } else {  // outer ring and holes as one path, so that holes stay open
    const auto& polygon = std::get<geometry::Polygon>(shapes.obstacle);
    text += "<path class=\"o\" d=\"M" + view.points(polygon.outer) + "Z";
    for (const Ring& hole : polygon.holes) text += " M" + view.points(hole) + "Z";
    text += "\"/>";
  }
  return text + "</svg><figcaption>" + escaped_markup(id) + "</figcaption></figure>\n";
}

std::string page_name(std::size_t page) {
  return page == 0 ? "index.html" : "page-" + std::to_string(page + 1) + ".html";
}

std::string page_head(std::size_t page, std::size_t pages, const std::string& summary) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Obstacles</title>\n<style>\n"
      "body{font:14px sans-serif;margin:1.5em;color:#222}h2{font-size:14px;margin:1.2em 0 .2em}p{margin:.2em 0;"
      "color:#555}div{display:flex;flex-wrap:wrap}figure{margin:2px;width:160px}figcaption{font-size:11px;"
      "text-align:center;color:#555;overflow:hidden}svg{width:160px;height:160px;background:#fafafa}\n"
      ".o{fill:#444;fill-rule:evenodd}.w{fill:none;stroke:#444;stroke-width:2}.h{fill:none;stroke:#e08214;"
      "stroke-dasharray:3 2}.e{fill:#4393c322;stroke:#4393c3}.t{fill:#5aae6122;stroke:#5aae61}"
      ".f{fill:none;stroke:#bbb;stroke-width:.6}\n</style></head><body>\n<h1>Obstacles</h1>\n<p>" +
      escaped_markup(summary) +
      "</p>\n<p>Dark: the obstacle. Orange: its hull. Blue: the smallest ellipse. Green: the trap-free ellipse. Grey: "
      "the "
      "facades' ellipses. The first " +
      std::to_string(kPicturesOfInput) + " obstacles of each file.</p>\n";
  if (pages > 1) {
    text += "<p>Pages:";
    for (std::size_t k = 0; k < pages; ++k) {
      const std::string number = std::to_string(k + 1);
      text += k == page ? " " + number : " <a href=\"" + page_name(k) + "\">" + number + "</a>";
    }
    text += "</p>\n";
  }
  return text;
}

std::string input_head(const std::string& file, const std::string& words) {
  return "<h2>" + escaped_markup(file) + "</h2><p>" + escaped_markup(words) + "</p><div>\n";
}

std::string input_foot() {
  return "</div>\n";
}

std::string page_foot(const std::string& provenance) {
  return "<!-- provenance: " + escaped_markup(provenance) + " -->\n</body></html>\n";
}

}  // namespace exactvo::datasets::batch
