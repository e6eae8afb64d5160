// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

#include "exactvo/datasets/markup.h"
#include "support/base64.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStyle =
    "body{font:16px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0;font-size:14px}td,th{border:1px solid #ccc;padding:.3em .6em;"
    "text-align:left;vertical-align:top}th{background:#f2f2f2}code{background:#f4f4f4;padding:0 .2em}"
    "figure{margin:1.5em 0}img{max-width:100%}figcaption{color:#555;font-size:14px}h2{border-bottom:1px solid #ccc}";

/// What stands between backticks is code.
std::string escaped_html(const std::string& text) {
  std::string out;
  bool code = false;
  for (const char c : datasets::escaped_markup(text)) {
    if (c != '`') {
      out += c;
      continue;
    }
    code = !code;
    out += code ? "<code>" : "</code>";
  }
  return out + (code ? "</code>" : "");
}

/// A cell of a Markdown table ends at a bar; a star or an angle bracket outside code would be markup.
std::string escaped_markdown(const std::string& text) {
  std::string out;
  bool code = false;
  for (const char c : text) {
    if (c == '`') code = !code;
    if (c == '|' || (!code && (c == '*' || c == '<' || c == '_'))) out += '\\';
    out += c;
  }
  return out;
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + escaped_markdown(cell) + " |";
  return row + "\n";
}

/// The formats in which a picture stands beside its PNG.
constexpr const char* kForPrint[] = {"pdf", "svg"};

std::string upper_case(std::string word) {
  for (char& c : word) c = static_cast<char>(c - 'a' + 'A');
  return word;
}

std::string beside(const std::string& picture, const std::string& format) {
  return fs::path(picture).replace_extension(format).string();
}

struct MarkdownWriter {
  std::string operator()(const Heading& h) const {
    return std::string(static_cast<std::size_t>(h.level), '#') + " " + escaped_markdown(h.text) + "\n\n";
  }
  std::string operator()(const Paragraph& p) const { return escaped_markdown(p.text) + "\n\n"; }
  std::string operator()(const Link& l) const { return "[" + escaped_markdown(l.text) + "](" + l.file + ")\n\n"; }
  std::string operator()(const Table& t) const {
    std::string text = markdown_row(t.head) + "|";
    for (std::size_t i = 0; i < t.head.size(); ++i) text += "---|";
    text += "\n";
    for (const auto& row : t.rows) text += markdown_row(row);
    return text + "\n";
  }
  std::string operator()(const Picture& p) const {
    std::string text = "![" + escaped_markdown(p.caption) + "](" + p.file + ")\n\n" + escaped_markdown(p.caption);
    for (const char* format : kForPrint) text += fmt::format(" [{}]({})", upper_case(format), beside(p.file, format));
    return text + "\n\n";
  }
};

std::optional<std::string> bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string html_row(const std::vector<std::string>& cells, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) row += fmt::format("<{0}>{1}</{0}>", tag, escaped_html(cell));
  return row + "</tr>\n";
}

struct HtmlWriter {
  const fs::path& folder;

  std::string operator()(const Heading& h) const {
    return fmt::format("<h{0}>{1}</h{0}>\n", h.level, escaped_html(h.text));
  }
  std::string operator()(const Paragraph& p) const { return "<p>" + escaped_html(p.text) + "</p>\n"; }
  std::string operator()(const Link& l) const {
    return fmt::format("<p><a href=\"{}\">{}</a></p>\n", l.file, escaped_html(l.text));
  }
  std::string operator()(const Table& t) const {
    std::string text = "<table>\n<thead>" + html_row(t.head, "th") + "</thead>\n<tbody>\n";
    for (const auto& row : t.rows) text += html_row(row, "td");
    return text + "</tbody>\n</table>\n";
  }
  std::string operator()(const Picture& p) const {
    const auto bytes = bytes_of(folder / p.file);
    const std::string caption = escaped_html(p.caption);
    const std::string image =
        bytes ? fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", caption, base64(*bytes))
              : "<p>(not drawn: " + escaped_html(p.file) + ")</p>";
    std::string links;
    for (const char* format : kForPrint) {
      const std::string file = beside(p.file, format);
      if (bytes && fs::exists(folder / file))
        links += fmt::format(" <a href=\"{}\">{}</a>", escaped_html(file), upper_case(format));
    }
    return "<figure>" + image + "<figcaption>" + caption + links + "</figcaption></figure>\n";
  }
};

}  // namespace

std::string markdown(const Document& document) {
  std::string text = "# " + escaped_markdown(document.title) + "\n\n";
  for (const Block& block : document.blocks) text += std::visit(MarkdownWriter{}, block);
  return text;
}

std::string html(const Document& document, const fs::path& folder) {
  const std::string title = escaped_html(document.title);
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + title +
                     "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + title + "</h1>\n";
  for (const Block& block : document.blocks) text += std::visit(HtmlWriter{folder}, block);
  return text + "</body>\n</html>\n";
}

}  // namespace exactvo::tools
