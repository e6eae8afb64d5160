// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Names and other words from files, made harmless for terminals, scripts and comments: no character of them may end
/// a line, start an escape sequence or hide text. Exact: what needs no escape comes back byte for byte.

#include <string>

namespace exactvo::tools {

/// `text` on one line: control characters (U+0000-U+001F, U+007F-U+009F), line separators, marks that turn the
/// direction of writing, and bytes that are no UTF-8 appear as \n, \t or \xNN. For everything that goes into a script,
/// a data file, a comment or one line of output.
std::string shown(const std::string& text);

/// The same, but line feeds stay: for messages of several lines.
std::string shown_lines(const std::string& text);

bool has_control_characters(const std::string& text);

}  // namespace exactvo::tools
