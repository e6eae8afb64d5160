// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The reproduction report: every equation, table and claim of the paper beside what was seen, from the files that the
/// runs left: summary.json and figures/ of Section V, random/random.json, ablations/ablations.json. Verdicts are
/// computed from those files; what was not run is said to be missing.
///
/// And what it is written into (document.cpp): headings, paragraphs, tables and pictures, as Markdown and as one
/// self-contained HTML file. Text is plain; `code` between backticks is set as code in both.

#include <filesystem>
#include <string>
#include <vector>

#include "paper/report_data.h"

namespace exactvo::tools {

// --- What it tells: the paper's equations (equations.json), and its claims, held against the runs (claims.cpp) ---

struct EquationPlace {
  std::string file;    ///< from the top of the sources
  std::string symbol;  ///< a name that stands in it
};

struct Equation {
  std::string number;       ///< "(15)"
  std::string printed;      ///< the paper's, in plain text
  std::string trouble;      ///< what is wrong with it; empty where nothing is
  std::string implemented;  ///< what runs by default
  std::vector<EquationPlace> places;
};

/// In the paper's order. A test sees that the files exist and hold the names.
const std::vector<Equation>& equations();

/// An open problem of the paper is solved or not; whatever runs are missing for is not run.
enum class Verdict { holds, holds_in_part, fails, not_run, solved, not_solved };
const char* name(Verdict verdict);  ///< "holds", "holds in part", "fails", "not run", "solved", "not solved"

struct Claim {
  std::string where;     ///< "Fig. 5, Section V.A"
  std::string text;      ///< what the paper says
  Verdict verdict;       ///< of the paper's own method (of the default, for what the paper leaves open), computed
  std::string evidence;  ///< the numbers behind it, and what the default does
  std::string figure;    ///< the picture that shows it, relative to the output folder
  std::string subject;   ///< the method or controller whose runs the verdict is on
};

std::vector<Claim> claims(const ReportData& data);

// --- The report ---

/// Written block by block, in both formats at once.
class Document {
 public:
  /// `folder`: the document's own. Files are named relative to it.
  Document(const std::string& title, std::filesystem::path folder);

  void heading(int level, const std::string& text);
  void paragraph(const std::string& text);
  void table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);
  /// `file` is a PNG. In Markdown a link to it; in HTML a part of the text itself, or said to be missing where it is
  /// not there. With links to the PDF and SVG beside it, in HTML where these are there.
  void picture(const std::string& file, const std::string& caption);
  /// A paragraph that leads to a file beside the document, which has a plain name.
  void link(const std::string& file, const std::string& text);

  const std::string& markdown() const { return markdown_; }
  std::string html() const { return html_ + "</body>\n</html>\n"; }

 private:
  std::filesystem::path folder_;
  std::string markdown_, html_;
};

/// Pictures are looked for in `folder`.
Document reproduction_report(const ReportData& data, const std::filesystem::path& folder);

/// report.html and report.md in `folder`, each whole or not at all.
void write_report(const ReportData& data, const std::filesystem::path& folder);

}  // namespace exactvo::tools
