#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs every fuzz target of a build with the preset fuzz, a minute each unless said:
#   tests/fuzz/run.sh build/fuzz [SECONDS]
# New inputs, crashes and a log of each target go to build/fuzz/found; seeds are the corpus and, where
# make_reader_seeds.sh has made them, build/fuzz/seeds. Status 1 where a target found something.
#
# Limits: 10 s and 2 GB an input, and 1 GB at once. A reader is to refuse what claims more than there is room for, so
# that none of these is reached: a second of each reader took 75 to 274 MB.
set -eu
build=$1
seconds=${2:-60}
here=$(dirname "$0")
targets=0
failed=0
for target in "$build"/bin/*_fuzz "$build"/bin/reader_fuzz_*; do
  [ -x "$target" ] || continue
  name=$(basename "$target")
  format=${name#reader_fuzz_}
  found=$build/found/$name
  mkdir -p "$found"
  set -- "$found"
  for seeds in "$here/../corpus/readers/$format" "$build/seeds/$format"; do
    [ ! -d "$seeds" ] || set -- "$@" "$seeds"
  done
  dictionary=$here/$format.dict
  [ ! -f "$dictionary" ] || set -- "-dict=$dictionary" "$@"
  targets=$((targets + 1))
  if "$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
      -artifact_prefix="$found-" -print_final_stats=1 "$@" > "$found.log" 2>&1; then
    echo "$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "$found.log") inputs, $(sed -n 's/^stat::peak_rss_mb: *//p' "$found.log") MB at most"
  else
    echo "$name: FOUND SOMETHING, see $found.log" >&2
    failed=1
  fi
done
[ "$targets" -gt 0 ] || { echo "no fuzz targets in $build/bin" >&2; exit 2; }
exit "$failed"
