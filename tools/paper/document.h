// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A document of headings, paragraphs, tables and pictures, as Markdown and as one self-contained HTML file.
///
/// Text is plain; `code` between backticks is set as code in both.

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace exactvo::tools {

struct Heading {
  int level = 2;
  std::string text;
};
struct Paragraph {
  std::string text;
};
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};
struct Picture {
  std::string file;  ///< a PNG, relative to the folder of the document
  std::string caption;
};
/// A paragraph that leads to a file beside the document.
struct Link {
  std::string file;  ///< a plain name, relative to the folder of the document
  std::string text;
};
using Block = std::variant<Heading, Paragraph, Table, Picture, Link>;

struct Document {
  std::string title;
  std::vector<Block> blocks;
};

/// Pictures as links to their files, with links to the PDF and SVG beside them.
std::string markdown(const Document& document);

/// Pictures in the text itself, read from `folder`, with links to the PDF and SVG beside them where these are there; a
/// picture that is not there is said to be missing.
std::string html(const Document& document, const std::filesystem::path& folder);

}  // namespace exactvo::tools
