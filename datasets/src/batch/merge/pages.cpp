// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/merge/pages.h"

#include <algorithm>
#include <memory>

#include "batch/formats/picture.h"
#include "batch/merge/outputs.h"
#include "batch/merge/summary.h"

namespace exactvo::datasets::batch {

void write_pages(const Journal& journal, const Identity& identity, const std::vector<InputFacts>& facts,
                 const std::string& words, const std::string& provenance) {
  const std::size_t pages = std::max<std::size_t>(1, (facts.size() + kInputsOfPage - 1) / kInputsOfPage);
  for (std::size_t page = 0; page < pages; ++page) {
    const std::unique_ptr<AtomicFile> file = output_file(journal.final_folder() / page_name(page));
    file->write(page_head(page, pages, words));
    const std::size_t end = std::min(facts.size(), (page + 1) * kInputsOfPage);
    for (std::size_t input = page * kInputsOfPage; input < end; ++input) {
      file->write(input_head(identity.inputs[input].name, words_of(facts[input])));
      if (facts[input].chunks > 0) file->write(read_pictures(journal, input));
      file->write(input_foot());
    }
    file->write(page_foot(provenance));
    file->commit();
  }
}

}  // namespace exactvo::datasets::batch
