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
