// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo segment: obstacles decomposed: facades, convex pieces, hulls, ellipses, each with its certificate.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/obstacle_record.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/obstacle_shapes.h"
#include "figures/figure.h"
#include "figures/outlines.h"
#include "figures/plane.h"
#include "support/escape.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

using geometry::counted;

using geometry::ObstacleShapes;

namespace {

struct SegmentFlags {
  std::vector<std::string> files;
  ReadingFlags reading;
  double tolerance = 0.0;
  double radius = 0.0;
  double facade_margin = geometry::FacadeEllipseOptions{}.margin;
  bool repair = false;
  bool json = false;
  bool metres = false;
  std::string out, figure;
};

struct Decomposed {
  datasets::RecordHead head;
  ObstacleShapes shapes;
  const datasets::ObstacleFile* file = nullptr;
};

// --- The work ---

void check(const SegmentFlags& flags) {
  require_length("--tolerance", flags.tolerance);
  require_length("--radius", flags.radius);
  require_length("--facade-margin", flags.facade_margin);
  if (!flags.figure.empty())
    check_figure_name("--figure", flags.figure, all_read_with(flags.files, flags.reading.format, flags.out));
  const std::string extension = std::filesystem::path(flags.out).extension().string();
  if (!flags.out.empty() && extension != ".jsonl" && extension != ".geojson")
    throw UsageError("--out", flags.out, "a name that ends in .jsonl or .geojson");
}

std::vector<Decomposed> decomposed(const std::vector<FileAnswer>& answers, const SegmentFlags& flags) {
  geometry::ShapeOptions options;
  options.facades.tolerance = flags.tolerance;
  options.robot_radius = flags.radius;
  options.facade_ellipses.margin = flags.facade_margin;
  options.check_validity = false;  // the reader did
  std::vector<Decomposed> all;
  for (const FileAnswer& answer : answers) {
    if (!answer.content) continue;
    for (const formation::SceneObstacle& o : answer.content->obstacles) {
      if (interrupted()) throw Interrupted();
      all.push_back({{answer.file, o.id, ""}, geometry::shapes_of(o.shape, options), &*answer.content});
    }
  }
  return all;
}

// --- Records and features ---

std::string records(const std::vector<Decomposed>& all) {
  std::string text;
  for (const Decomposed& t : all) text += datasets::to_json(t.head, t.shapes) + "\n";
  return text;
}

OrderedJson positions(const Points& points) {
  OrderedJson list = OrderedJson::array();
  for (const geometry::Vec2 p : points) list.push_back({p.x, p.y});
  return list;
}

/// The points are metres or degrees already.
OrderedJson ring_geometry(const Points& ring) {
  if (ring.size() == 1) return {{"type", "Point"}, {"coordinates", positions(ring)[0]}};
  if (ring.size() == 2) return {{"type", "LineString"}, {"coordinates", positions(ring)}};
  Points closed = ring;
  closed.push_back(ring.front());
  return {{"type", "Polygon"}, {"coordinates", OrderedJson::array({positions(closed)})}};
}

/// In degrees each file's obstacles lie where its plane does.
class Features {
 public:
  explicit Features(bool metres) : metres_(metres) {}

  void add(const Decomposed& t) {
    choose_plane(*t.file);
    const ObstacleShapes& s = t.shapes;
    for (const geometry::Segment& f : s.facades.facades) feature(t, "facade", s.facades_follow, {f.a, f.b});
    for (const geometry::ConvexShape& piece : s.pieces) feature(t, "piece", s.pieces_cover, outline(piece));
    feature(t, "hull", s.hull_contains, s.hull.vertices);
    ellipse(t, "smallest ellipse", s.ellipse_contains, s.smallest_ellipse);
    for (const geometry::FacadeEnclosure& e : s.facade_ellipses)
      ellipse(t, "facade ellipse", s.facade_ellipses_contain, e.ellipse);
    if (s.trap_free.ellipse) ellipse(t, "trap-free ellipse", s.trap_free_contains, *s.trap_free.ellipse);
  }

  /// "local_metres" stands there where all lie on one plane.
  std::string text() const {
    OrderedJson collection{{"type", "FeatureCollection"}};
    if (metres_) {
      collection["units"] = "m";
    } else if (planes_ == 1) {
      collection["local_metres"] = OrderedJson::parse(datasets::local_metres_member(plane_, -1));
    }
    collection["features"] = features_;
    return text_of(collection);
  }

 private:
  void choose_plane(const datasets::ObstacleFile& file) {
    if (metres_ || file_ == &file) return;
    file_ = &file;
    ++planes_;
    plane_ = file.plane;
    if (!plane_.is_placed() && file.extent) plane_.offset = datasets::offset_for(file.extent->low, file.extent->high);
    note_place_on_earth(plane_);
    to_degrees_ = std::make_unique<datasets::MetresToDegrees>(plane_, file.file);
  }

  static OrderedJson head(const Decomposed& t, const char* what) {
    return {{"file", t.head.file}, {"id", t.head.id}, {"shape", what}};
  }

  void add(OrderedJson properties, const Points& points) {
    features_.push_back({{"type", "Feature"},
                         {"properties", std::move(properties)},
                         {"geometry", ring_geometry(to_degrees_ ? (*to_degrees_)(points) : points)}});
  }

  void feature(const Decomposed& t, const char* what, const geometry::Verdict& verdict, const Points& points) {
    OrderedJson properties = head(t, what);
    properties["certified"] = verdict.certified;
    add(std::move(properties), points);
  }

  /// The drawn outline has its corners on the ellipse and so lies within it: the certificate is the ellipse's, whose
  /// numbers, m, stand beside it.
  void ellipse(const Decomposed& t, const char* what, const geometry::Verdict& verdict, const geometry::Ellipse& e) {
    OrderedJson properties = head(t, what);
    properties["ellipse_certified"] = verdict.certified;
    properties["center_x"] = e.center.x;
    properties["center_y"] = e.center.y;
    properties["l11"] = e.l11;
    properties["l21"] = e.l21;
    properties["l22"] = e.l22;
    add(std::move(properties), outline(e));
  }

  bool metres_;
  const datasets::ObstacleFile* file_ = nullptr;  ///< of the obstacle before
  datasets::LocalPlane plane_;
  int planes_ = 0;
  std::unique_ptr<datasets::MetresToDegrees> to_degrees_;
  OrderedJson features_ = OrderedJson::array();
};

void write_out(const std::vector<Decomposed>& all, const SegmentFlags& flags) {
  const std::string& out = flags.out;
  if (std::filesystem::path(out).extension() == ".jsonl") return datasets::write_file_atomically(out, records(all));
  Features features(flags.metres);
  for (const Decomposed& t : all) features.add(t);
  datasets::write_file_atomically(out, features.text());
}

/// What a vertex and an obstacle become in --out, bytes: measured on what `generate` makes, within a factor of two.
struct SizesOut {
  double a_vertex;
  double an_obstacle;
};
constexpr SizesOut kRecords{190.0, 1500.0}, kFeatures{25500.0, 50000.0};

/// Before the work, as `batch` does.
void say_size(const std::vector<FileAnswer>& answers, const SegmentFlags& flags) {
  std::size_t obstacles = 0, vertices = 0;
  double input = 0.0;
  for (const FileAnswer& answer : answers) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(answer.file, error);
    input += error ? 0.0 : static_cast<double>(size);
    obstacles += answer.content->obstacles.size();
    for (const formation::SceneObstacle& o : answer.content->obstacles)
      vertices += geometry::vertices_of(o.shape).size();
  }
  const SizesOut sizes = std::filesystem::path(flags.out).extension() == ".jsonl" ? kRecords : kFeatures;
  const double out =
      sizes.a_vertex * static_cast<double>(vertices) + sizes.an_obstacle * static_cast<double>(obstacles);
  message(fmt::format("{}, {}, {}: about {} in {}", counted(answers.size(), "file"), size_text(input),
                      counted(vertices, "vertex", "vertices"), size_text(out), flags.out));
}

// --- Words ---

const char* word(const geometry::Verdict& verdict) {
  return verdict.certified ? "certified" : "NOT certified";
}

std::string words_of(const Decomposed& t) {
  const ObstacleShapes& s = t.shapes;
  const geometry::ShapeMeasurements& f = s.measurements;
  return fmt::format(
      "{} {}: {}, {:.6g} m^2; {} within {:.3g} m ({}), {} ({}), hull {:.6g} m^2 ({}), "
      "ellipse {:.6g} m^2 ({}), facade ellipses ({}), trap-free {}\n",
      shown(t.head.file), shown(t.head.id), counted(f.vertices, "vertex", "vertices"), f.area,
      counted(s.facades.facades.size(), "facade"), s.facades.deviation, word(s.facades_follow),
      counted(s.pieces.size(), "piece"), word(s.pieces_cover), f.hull_area, word(s.hull_contains), f.ellipse_area,
      word(s.ellipse_contains), word(s.facade_ellipses_contain),
      s.trap_free.ellipse ? fmt::format("{:.6g} m^2 ({})", f.trap_free_area, word(s.trap_free_contains)) : "none");
}

// --- The figure ---

/// Neighbouring pieces in different colours, as far as taking turns does that.
void draw_pieces(const std::vector<Decomposed>& obstacles, MapLayers& map) {
  constexpr std::size_t kColours = 4;
  std::vector<std::vector<Points>> by_colour(kColours);
  for (const Decomposed& t : obstacles) {
    std::size_t turn = 0;
    for (const geometry::ConvexShape& piece : t.shapes.pieces)
      if (const Points ring = outline(piece); ring.size() > 2) by_colour[turn++ % kColours].push_back(ring);
  }
  bool in_key = true;
  for (std::size_t k = 0; k < kColours; ++k) {
    map.curves("convex pieces", by_colour[k],
               fmt::format("with filledcurves closed fs transparent solid 0.22 border lc rgb '#8a919c' fc rgb '{}'",
                           series_colour(k + 1)),
               true, in_key);
    in_key = in_key && by_colour[k].empty();
  }
}

/// Pieces filled in pale colours, facades as bold lines, hulls dashed, the smallest ellipses, the facades' and the
/// trap-free ones.
Figure shapes_figure(const std::vector<Decomposed>& obstacles, const std::string& title) {
  MapLayers map;
  std::vector<formation::SceneObstacle> all;
  for (const Decomposed& t : obstacles) all.push_back({"", t.shapes.obstacle});
  constexpr std::size_t kMostDrawnBold = 40;
  const bool crowded = obstacles.size() > kMostDrawnBold;
  map.obstacles(all);
  draw_pieces(obstacles, map);
  std::vector<Points> of_facades, hulls, smallest, trap_free, facades;
  for (const Decomposed& t : obstacles) {
    const ObstacleShapes& s = t.shapes;
    for (const geometry::FacadeEnclosure& e : s.facade_ellipses) of_facades.push_back(outline(e.ellipse));
    hulls.push_back(s.hull.vertices);
    smallest.push_back(outline(s.smallest_ellipse));
    if (s.trap_free.ellipse) trap_free.push_back(outline(*s.trap_free.ellipse));
    for (const geometry::Segment& f : s.facades.facades) facades.push_back({f.a, f.b});
  }
  map.curves("facade ellipses", of_facades, line_style(crowded ? 0.4 : 0.8, "#56B4E9"), true);
  map.curves("hulls", hulls, line_style(1.6, "#009E73", " dt (8,5)"), true);
  map.curves("smallest ellipses", smallest, line_style(1.8, "#0072B2"), true);
  map.curves("trap-free ellipses", trap_free, line_style(1.8, "#CC79A7", " dt (3,3)"), true);
  map.curves("facades", facades,
             crowded ? line_style(1.0, "#D55E00") : "with linespoints lw 2.2 pt 7 ps 0.35 lc rgb '#D55E00'", false);
  return map.figure(title);
}

// --- The verb ---

ExitCode exit_code(const std::vector<FileAnswer>& answers, const std::vector<Decomposed>& all) {
  const bool all_read = std::all_of(answers.begin(), answers.end(), [](const FileAnswer& a) { return a.is_whole(); });
  const bool proved = std::all_of(all.begin(), all.end(), [](const Decomposed& t) { return t.shapes.certified(); });
  return all_read && proved ? ExitCode::success : ExitCode::negative;
}

ExitCode segment(const SegmentFlags& flags) {
  check(flags);
  datasets::ReadOptions reading = reading_options(flags.reading);
  reading.repair = flags.repair;
  for (const std::string& file : flags.files) refuse_input_as_output(file, flags.reading.format, "--out", flags.out);
  const std::vector<FileAnswer> answers = read_each(flags.files, reading);
  for (const FileAnswer& answer : answers) {
    if (!answer.error) continue;
    error_message(answer.error->what() + guess_words(answer));
    return ExitCode::bad_input;
  }
  for (const FileAnswer& answer : answers) {
    for (const datasets::DataError& error : answer.content->rejected) message(std::string("left out: ") + error.what());
  }
  if (!flags.out.empty()) say_size(answers, flags);
  const std::vector<Decomposed> all = decomposed(answers, flags);
  for (const FileAnswer& answer : answers) {
    if (answer.content->obstacles.empty()) message("no obstacle in " + counts_line(answer));
  }
  if (!flags.out.empty()) {
    write_out(all, flags);
    message("wrote " + flags.out);
  }
  if (!flags.figure.empty() && all.empty()) message("no figure: no obstacle");
  if (!flags.figure.empty() && !all.empty()) {
    const std::string name = std::filesystem::path(flags.files.front()).filename().string();
    write_figure(shapes_figure(all, fmt::format("{}{}: {}", name, flags.files.size() > 1 ? " and others" : "",
                                                counted(all.size(), "obstacle"))),
                 flags.figure);
  }
  if (flags.json) print(records(all));
  if (!flags.json && flags.out.empty()) {
    for (const Decomposed& t : all) print(words_of(t));
  }
  return exit_code(answers, all);
}

void declare_segment(CLI::App& app, SegmentFlags& flags) {
  app.add_option("files", flags.files, "Obstacle files of any readable format")->required();
  declare_reading_flags(app, flags.reading);
  app.add_option("--tolerance", flags.tolerance, "Largest distance of a facade from its obstacle, m");
  app.add_option("--radius", flags.radius, "Radius of the robot, for clearances by equation (8), m");
  app.add_option("--facade-margin", flags.facade_margin,
                 "Least depth of a facade inside its ellipse, m; choose a smaller value for obstacles of millimetres")
      ->capture_default_str();
  app.add_flag("--repair", flags.repair, "Repair invalid geometry first");
  app.add_flag("--json", flags.json, "One JSON record per obstacle and line on stdout");
  declare_metres(app, flags.metres);
  app.add_option("--out", flags.out, "FILE.jsonl: the records; FILE.geojson: every shape as a feature");
  app.add_option("--figure", flags.figure, kFigureFileHelp);
}

}  // namespace

Verb segment_verb() {
  return {"segment", "Decompose obstacles: facades, convex pieces, hulls, ellipses, with certificates",
          "  exactvo segment floor.geojson --figure floor.svg\n"
          "  exactvo segment city.gpkg --repair --tolerance 0.1 --out city.jsonl\n"
          "    (status 1: an obstacle is invalid, or a result is not certified)\n",
          with_flags(declare_segment, segment)};
}

}  // namespace exactvo::tools
