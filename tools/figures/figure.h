// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A figure is a data file, the gnuplot script that draws it, and what gnuplot made of the two: NAME.dat, NAME.gp,
/// NAME.svg, NAME.png and NAME.pdf in one folder. The first two are meant to be read and edited: `gnuplot NAME.gp` in
/// that folder draws the pictures again.
///
/// gnuplot runs what stands in the name of a file behind `<` or `|`. So a script names plain files only (`plain_name`),
/// and whoever was asked for another name renames the pictures once they are drawn (`write_figure`).
///
/// The scripts are files to edit: tools/figures/templates/NAME.gp, embedded in the program when it is built. `@place@`
/// in them stands for what the program fills in.
///
/// See also: gnuplot.h runs the scripts; outlines.h has the colours; run_figures.h
/// and velocity_space.h make figures.

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/geometry/vec2.h"

namespace exactvo::tools {

struct Canvas {
  int width = 960;   ///< px of the SVG, 1/96 inch of the PDF; the PNG has 1.4 times as many
  int height = 600;  ///< the same
};

struct Figure {
  std::string name;   ///< the stem of every file; plain
  std::string data;   ///< text of NAME.dat
  std::string shows;  ///< in a sentence; the first line of the script
  Canvas canvas;
  std::string body;  ///< of the script: settings and plot commands, which name the data file as `data`
};

/// The text of NAME.gp: what the figure shows, then its body drawn once for each format.
/// REQUIRES: a plain name.
std::string script_text(const Figure& figure);

/// `name` where it is plain: letters and digits of any script, `_`, `-`, `.` and spaces, the first one neither a space
/// nor `-`. Else a plain one made of it, different for different names.
std::string plain_name(const std::string& name);

/// Writes NAME.dat and NAME.gp into `folder`, which must exist, and returns the path of the script.
/// Throws datasets::DataError where it cannot. REQUIRES: a plain name.
std::filesystem::path write_sources(const Figure& figure, const std::filesystem::path& folder);

/// The text of a gnuplot data file: numbered data sets, each with a title and its columns in a comment.
class DataFile {
 public:
  /// Starts a data set and returns the number that `index` takes in a script.
  int begin(const std::string& title, const std::string& columns);
  /// One line of the current data set. Numbers have nine significant digits, which is enough for drawing; from 10^5 on
  /// as many as it takes to read the same doubles back.
  void row(const std::vector<double>& values);
  /// One line per point.
  void rows(const std::vector<geometry::Vec2>& points) {
    for (const geometry::Vec2 p : points) row({p.x, p.y});
  }
  /// The same, with the pen lifted behind them.
  void curve(const std::vector<geometry::Vec2>& points);
  /// The same, closed; nothing of no points.
  void ring(const std::vector<geometry::Vec2>& points);
  /// One line of numbers and a closing word of the program's own, for labels; gnuplot's markup works in it.
  void labelled_row(const std::vector<double>& values, const std::string& label);
  /// Lifts the pen: the next row starts a new curve or polygon of the same data set. Lifted twice is lifted once.
  void gap();
  const std::string& text() const { return text_; }

 private:
  /// gnuplot does not count a data set without rows: it gets one that draws nothing.
  void fill_if_empty() {
    if (empty_) text_ += "NaN NaN NaN NaN\n";
  }

  std::string text_;
  int count_ = 0;
  bool empty_ = false;  ///< the current data set has no row yet
  bool lifted_ = true;
};

/// Items of one `plot` command.
class PlotCommand {
 public:
  /// `what` as gnuplot has it after the data file's name: "index 3 using 1:2 with lines ...".
  /// An empty title keeps the item out of the legend.
  void data(int index, const std::string& what, const std::string& title = "");
  /// An item that is no data set: a function or a key entry, complete but for its title.
  void item(const std::string& what, const std::string& title = "");
  std::string text() const;

 private:
  std::vector<std::string> items_;
};

/// `text` as a gnuplot string that is drawn as it stands: no quote left open, nothing of it run, control characters
/// shown (support/escape.h), and @ { } ^ _ & ~ \ letters rather than markup. Every word from outside enters a script
/// through here.
std::string quoted(const std::string& text);

/// `text` of the program's own as a gnuplot string with gnuplot's markup: "{/:Italic a}_{k+1}".
std::string markup(const std::string& text);

/// `text` as a gnuplot comment or the rest of one: one line, which neither continues nor runs anything.
std::string commented(const std::string& text);

/// `text` in at most `most` characters (UTF-8), with an ellipsis in the middle where it was longer; `most` >= 3.
std::string shortened(const std::string& text, std::size_t most);

/// Robots that a legend names one by one.
inline constexpr std::size_t kMostInLegend = 60;

/// What a legend says of robot i of `count`: its name, up to 60 robots. Beyond that names would fill the sheet: the
/// first entry stands for all ("300 robots"), and the others have none.
std::string robot_in_legend(std::size_t i, std::size_t count, const std::string& name, std::size_t longest);

/// Robots 0, ..., count - 1 by the data set that they are drawn with: each alone as long as a legend names them; beyond
/// that robot i together with i + styles, i + 2 styles and so on, which look alike. Else a script would have thousands
/// of data sets, for each of which gnuplot reads the file from its beginning.
std::vector<std::vector<std::size_t>> drawn_together(std::size_t count, std::size_t styles);

/// "R1", or "R1 and 3 more" of some that are drawn together.
template <class NameOf>
std::string names_of(const std::vector<std::size_t>& robots, const NameOf& name_of) {
  const std::string first = name_of(robots.front());
  return robots.size() == 1 ? first : first + " and " + std::to_string(robots.size() - 1) + " more";
}

/// How many characters of a title go into this many pixels of the SVG.
std::size_t characters_in(double pixels);

/// Texts by place.
using Filling = std::map<std::string, std::string>;

/// The text of every template by its name, without ".gp".
const std::map<std::string, std::string>& embedded_templates();

/// `text` with every `@place@` replaced once: what is filled in is not searched for places.
/// Throws std::logic_error where a place is not filled, or nothing has that place.
std::string filled_text(const std::string& text, const Filling& filling);

/// The same for the template `name`.
std::string filled(const std::string& name, const Filling& filling);

// --- Several plots side by side on one sheet, each with a letter, and one legend below all of them. Axis labels stand
// at the left and below only: all panels of a sheet have the same quantities on their axes ---

/// "(a)", ..., "(z)", "(27)", ...
std::string letter_of(std::size_t panel);

struct SheetPanel {
  std::string title;     ///< a gnuplot string (quoted, markup), with its letter
  std::string settings;  ///< the ranges, and whatever else is the panel's own
  std::string plot;      ///< its plot command
};

struct Sheet {
  std::string title;             ///< a gnuplot string
  std::string x_label, y_label;  ///< the same
  int columns = 1;
  double panel_width = 250.0;   ///< px of what the axes enclose
  double panel_height = 250.0;  ///< px; a plane is to scale where the panels' ranges have the same ratio
  double gap = 40.0;            ///< px between columns, for the numbers at the axes
  std::vector<SheetPanel> panels;
  /// The entries of the legend: what gnuplot draws ("keyentry with ..."), and its words.
  std::vector<std::pair<std::string, std::string>> legend;
};

/// REQUIRES: a panel, a plain name.
Figure sheet_figure(const std::string& name, const std::string& data, const std::string& shows, const Sheet& sheet);

// --- One figure for a verb: FILE.svg, FILE.png, FILE.pdf, whichever the user names, with FILE.dat and FILE.gp ---

/// What the help of an option says of the file it names.
inline constexpr const char* kFigureFileHelp =
    "FILE.svg, FILE.png or FILE.pdf: all three are written, with FILE.dat and FILE.gp (gnuplot)";

/// Throws UsageError unless the name ends in .svg, .png or .pdf, is printable, and none of the files that would be
/// written is a folder or one of `others`, the files that the command reads and writes besides. An empty name passes.
/// `option` is where the name was given. To be called before the work.
void check_figure_name(const std::string& option, const std::string& name,
                       const std::vector<std::filesystem::path>& others);

/// Draws in a folder of its own under a plain name and moves the files into place together: the pictures under exactly
/// the name that was asked for, data and script under the plain one, which is the same for ordinary names. A picture
/// that could not be drawn is removed if an earlier figure left one of its name, that is, if the figure's script was
/// there before. The figure's own name does not matter.
void write_figure(Figure figure, const std::filesystem::path& out);

}  // namespace exactvo::tools
