// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/corpus.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace exactvo::test {
namespace {

CorpusCase parse_line(const std::string& line, const std::string& place) {
  std::istringstream words(line);
  CorpusCase corpus_case;
  words >> corpus_case.kind;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    corpus_case.numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0') throw std::runtime_error(place + ": found \"" + word + "\", expected a number");
  }
  return corpus_case;
}

}  // namespace

std::vector<CorpusCase> parse_corpus(const std::string& text, const std::string& name) {
  std::vector<CorpusCase> cases;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    cases.push_back(parse_line(line, name + ", line " + std::to_string(number)));
  }
  return cases;
}

std::vector<CorpusCase> read_corpus(const std::string& name) {
  std::ifstream file(std::string(EXACTVO_CORPUS_DIR) + "/" + name);
  if (!file) throw std::runtime_error("no corpus file " + name);
  std::ostringstream text;
  text << file.rdbuf();
  return parse_corpus(text.str(), name);
}

geometry::Ring ring_of(const CorpusCase& corpus_case) {
  const std::vector<double>& numbers = corpus_case.numbers;
  if (corpus_case.kind != "ring" || numbers.size() % 2 != 1 ||
      numbers.front() != static_cast<double>(numbers.size() / 2)) {
    throw std::runtime_error("found a case \"" + corpus_case.kind + "\" of " + std::to_string(numbers.size()) +
                             " numbers, expected \"ring n x1 y1 ... xn yn\"");
  }
  geometry::Ring ring;
  for (std::size_t i = 1; i < numbers.size(); i += 2) ring.push_back({numbers[i], numbers[i + 1]});
  return ring;
}

std::string corpus_line(const geometry::Ring& ring) {
  return "ring " + geometry::to_string(ring);
}

}  // namespace exactvo::test
