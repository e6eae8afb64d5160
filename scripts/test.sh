#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, builds everything with assertions on, and runs every test. Arguments go to ctest:
# `scripts/test.sh -L unit`, `scripts/test.sh -R VelocityObstacle`.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$root"

say "Packages"
scripts/install-dependencies.sh

say "Building build/dev, $(compile_jobs) job(s)"
cmake --preset dev
cmake --build --preset dev --parallel "$(compile_jobs)"

say "Tests"
ctest --preset dev --parallel "$(nproc)" "$@"
