// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace exactvo::datasets {

/// Refuses a PNG file one of whose chunks claims more bytes than the file has left (DataCode::size): decoders make room
/// for what is claimed before they read it. What is no PNG, or is cut between chunks, is left to the decoder.
void require_whole_png_chunks(const std::filesystem::path& path);

}  // namespace exactvo::datasets
