// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A folder in which batches of FOLDER/in run.

#include "batch_files.h"
#include "exactvo/datasets/batch.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {

class BatchFolder : public TemporaryFolder {
 protected:
  explicit BatchFolder(int workers) : workers_(workers) {}

  BatchRun run_to(const std::string& out) const {
    BatchRun run;
    run.paths = {folder_ / "in"};
    run.out = folder_ / out;
    run.workers = workers_;
    return run;
  }

  BatchConfiguration plain_;

 private:
  int workers_;
};

}  // namespace exactvo::datasets::test
