// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// index.html and the pages after it: small pictures of every input's first obstacles.

#include <string>
#include <vector>

#include "batch/plan/input_record.h"
#include "batch/plan/journal.h"

namespace exactvo::datasets::batch {

/// Writes them to `journal.final_folder()`, from the parts on disk. `facts` are those of every input, `words` stand at
/// the head of each page. Throws DataError (E_FILE_UNWRITABLE; E_FORMAT_SYNTAX for a part that is none).
void write_pages(const Journal& journal, const Identity& identity, const std::vector<InputFacts>& facts,
                 const std::string& words, const std::string& provenance);

}  // namespace exactvo::datasets::batch
