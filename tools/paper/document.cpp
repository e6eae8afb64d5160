// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/report.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "exactvo/datasets/markup.h"
#include "explorer/page.h"

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
constexpr std::pair<const char*, const char*> kForPrint[] = {{"pdf", "PDF"}, {"svg", "SVG"}};

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

}  // namespace

Document::Document(const std::string& title, fs::path folder)
    : folder_(std::move(folder)), markdown_("# " + escaped_markdown(title) + "\n\n") {
  const std::string head = escaped_html(title);
  html_ = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + head +
          "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + head + "</h1>\n";
}

void Document::heading(int level, const std::string& text) {
  markdown_ += std::string(static_cast<std::size_t>(level), '#') + " " + escaped_markdown(text) + "\n\n";
  html_ += fmt::format("<h{0}>{1}</h{0}>\n", level, escaped_html(text));
}

void Document::paragraph(const std::string& text) {
  markdown_ += escaped_markdown(text) + "\n\n";
  html_ += "<p>" + escaped_html(text) + "</p>\n";
}

void Document::table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  markdown_ += markdown_row(head) + "|";
  for (std::size_t i = 0; i < head.size(); ++i) markdown_ += "---|";
  markdown_ += "\n";
  html_ += "<table>\n<thead>" + html_row(head, "th") + "</thead>\n<tbody>\n";
  for (const auto& row : rows) {
    markdown_ += markdown_row(row);
    html_ += html_row(row, "td");
  }
  markdown_ += "\n";
  html_ += "</tbody>\n</table>\n";
}

void Document::picture(const std::string& file, const std::string& caption) {
  const std::string in_markdown = escaped_markdown(caption), in_html = escaped_html(caption);
  const auto bytes = bytes_of(folder_ / file);
  markdown_ += "![" + in_markdown + "](" + file + ")\n\n" + in_markdown;
  html_ += "<figure>" +
           (bytes ? fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", in_html, base64(*bytes))
                  : "<p>(not drawn: " + escaped_html(file) + ")</p>") +
           "<figcaption>" + in_html;
  for (const auto& [extension, name] : kForPrint) {
    const std::string beside = fs::path(file).replace_extension(extension).string();
    markdown_ += fmt::format(" [{}]({})", name, beside);
    if (bytes && fs::exists(folder_ / beside))
      html_ += fmt::format(" <a href=\"{}\">{}</a>", escaped_html(beside), name);
  }
  markdown_ += "\n\n";
  html_ += "</figcaption></figure>\n";
}

void Document::link(const std::string& file, const std::string& text) {
  markdown_ += "[" + escaped_markdown(text) + "](" + file + ")\n\n";
  html_ += fmt::format("<p><a href=\"{}\">{}</a></p>\n", file, escaped_html(text));
}

}  // namespace exactvo::tools
