// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Characters of figures that no font of this machine has. Pango draws their numbers in a box instead, which covers a
/// whole PNG or PDF of gnuplot.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace exactvo::tools {

/// The characters in these scripts and in their data that no installed font has. None where the fonts are not known,
/// for lack of the program fc-list.
std::set<char32_t> characters_without_font(const std::vector<std::filesystem::path>& scripts);

/// `text` with a hollow square in the place of each of `missing`.
std::string with_squares(const std::string& text, const std::set<char32_t>& missing);

/// At most ten of them, in UTF-8: "A B C and 2 more".
std::string listed_characters(const std::set<char32_t>& characters);

/// Writes a copy of the script that draws the same pictures in the same place with squares for `missing`, and of its
/// data, into `folder` with this name. Returns the script.
std::filesystem::path copy_with_squares(const std::filesystem::path& script, const std::set<char32_t>& missing,
                                        const std::filesystem::path& folder, const std::string& name);

}  // namespace exactvo::tools
