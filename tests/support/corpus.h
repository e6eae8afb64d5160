// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The corpus: what once went wrong, as text (tests/corpus/README.md has the format). A failing geometric test prints
/// its case with `corpus_line`; the line, pasted into a file of tests/corpus/, is read back here, bit for bit.

#include <string>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::test {

/// One line of a corpus file: "ring 3 0x0p+0 ...".
struct CorpusCase {
  std::string kind;             ///< "ring", "disc", "ellipse", ...
  std::vector<double> numbers;  ///< all that follows
};

/// The cases of tests/corpus/`name`, in order. Throws std::runtime_error with file and line for what it can't read.
std::vector<CorpusCase> read_corpus(const std::string& name);

/// The same from text; `name` is for messages.
std::vector<CorpusCase> parse_corpus(const std::string& text, const std::string& name);

/// The vertices of a "ring" case. Throws std::runtime_error for another kind or a wrong count.
geometry::Ring ring_of(const CorpusCase& corpus_case);

/// The line of a ring; without a newline.
std::string corpus_line(const geometry::Ring& ring);

}  // namespace exactvo::test
