#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, builds the program, runs the paper's experiments and the office crossing, prints what came
# out and names the figures. Results go to out/ beside the sources. Run again, it builds only what changed.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$root"

say "Packages"
scripts/install-dependencies.sh program

say "Building build/release/bin/exactvo, $(compile_jobs) job(s)"
cmake --preset release
cmake --build --preset release --target exactvo --parallel "$(compile_jobs)"
exactvo=build/release/bin/exactvo

say "The paper's experiments (Section V)"
"$exactvo" paper --out out/paper

say "Six robots cross an office floor"
"$exactvo" simulate datasets/data/office/office.json --method ivo --out out/office

say "Figures"
echo "Every figure is .png, .svg and .pdf, with its data (.dat) and gnuplot script (.gp) beside it."
ls out/paper/figures/*.png
echo "out/paper/report.html: equations, claims with their verdicts, tables and pictures, in one file"
echo "out/paper/explorer.html, out/office/explorer.html: every run in a browser, with velocity space and proofs"
echo "out/paper/figures/{fig5-orca,fig6-ivo}/A0..A15/ and fig8-formation/B0..B3/: paths, distances, velocities, errors"
ls out/office/figures/*.png
