// SPDX-License-Identifier: GPL-3.0-or-later
#include "explorer/page.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace exactvo::tools {

namespace {

/// Nothing but base64 reaches the markup, whatever names and titles hold.
std::string element(const char* kind, const std::string& bytes) {
  return std::string("<script type=\"text/plain\" class=\"") + kind + "\">" + base64(bytes) + "</script>\n";
}

}  // namespace

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

std::string page_key(const std::string& text) {
  constexpr std::size_t kLongest = 80;
  std::string key;
  for (const char c : text) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
    key += plain ? c : '-';
  }
  return key.substr(0, kLongest);
}

std::string title_of(const datasets::RecordingFile& file) {
  const datasets::RunInfo& info = file.info;
  return info.scenario + ", " + info.method + (info.controller ? ", " + *info.controller : "") +
         (info.guidance ? ", " + *info.guidance : "");
}

PageRun recorded_run(const datasets::RecordingFile& file, const std::string& metrics_json, PackedRunLimits limits) {
  const std::string title = title_of(file);
  return {page_key(title), title, "", packed_run(file, metrics_json, limits)};
}

void make_key_distinct(PageRun& run, const std::set<std::string>& taken) {
  const std::string key = run.key;
  std::size_t number = 1;
  while (taken.count(run.key) > 0) run.key = key + "-" + std::to_string(++number);
  if (number > 1) run.title += " (" + std::to_string(number) + ")";
}

std::string explorer_page(const std::vector<PageRun>& runs, bool is_guide) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string elements;
  for (const PageRun& run : runs) {
    list.push_back({{"key", run.key}, {"title", run.title}, {"description", run.description}});
    elements += element("run", run.packed);
  }
  const nlohmann::ordered_json about = {{"guide", is_guide}, {"runs", list}};
  const std::string words = about.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  const std::string shell = kExplorerShell, mark = "__RUNS__";
  const std::size_t place = shell.find(mark);
  if (place == std::string::npos) throw std::logic_error("the page has no place for runs");
  return shell.substr(0, place) + element("runs", words) + elements + shell.substr(place + mark.size());
}

}  // namespace exactvo::tools
