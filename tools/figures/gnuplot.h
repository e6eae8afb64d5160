// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Runs gnuplot on scripts that stand beside their data.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace exactvo::tools {

enum class Rendering {
  done,
  no_gnuplot,  ///< the program is not installed: the scripts and data stand, the pictures do not
  failed
};

struct RenderResult {
  Rendering outcome = Rendering::done;
  std::string message;  ///< what gnuplot said, where it failed
  /// The formats that this gnuplot was built without, each with its terminal.
  std::vector<std::string> missing;
};

/// Gets from time to time how many pictures have been drawn, of how many.
using RenderProgress = std::function<void(std::size_t drawn, std::size_t pictures)>;

/// SVG, PNG and PDF.
inline constexpr std::size_t kPicturesOfScript = 3;

/// Draws every script, each from within its own folder, in every format that this gnuplot has, in a gnuplot process per
/// processor, four at most. The pictures do not depend on how many there are. Where it fails, no picture of these
/// scripts is left.
RenderResult render(const std::vector<std::filesystem::path>& scripts, const RenderProgress& progress = {});

}  // namespace exactvo::tools
