#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Seeds of the readers' fuzz targets from the public files beside the checkout:
#   tests/fuzz/make_reader_seeds.sh ../shared/data build/fuzz/seeds
# then e.g. build/fuzz/bin/reader_fuzz_wkt -max_total_time=60 -timeout=10 -rss_limit_mb=2048 build/fuzz/seeds/wkt
# Long files are cut: a fuzzer that copies megabytes tries little.
set -eu
data=$1
out=$2
most=24000

# seed FORMAT FILE...
seed() {
  format=$1
  shift
  mkdir -p "$out/$format"
  for file in "$@"; do
    [ -f "$file" ] || continue
    head -c "$most" "$file" > "$out/$format/$(basename "$(dirname "$file")")-$(basename "$file")"
  done
}

# A case of a ROS map is the yaml, a mark, and the picture's bytes; yaml and picture agree on the name.
ros_seed() {
  yaml=$1
  picture=$2
  mkdir -p "$out/ros-map"
  case=$out/ros-map/$(basename "$(dirname "$yaml")")-$(basename "$picture")
  sed "s/^image:.*/image: map.${picture##*.}/" "$yaml" > "$case"
  printf '\n%%picture%%\n' >> "$case"
  head -c "$most" "$picture" >> "$case"
}

seed wkt "$data"/wkt-*/*.wkt
seed jupedsim-wkt "$data"/jupedsim-wkt/*
seed gdal "$data"/geojson-*/*.geojson
seed movingai-map "$data"/movingai*/*.map
seed carmen-log "$data"/laser-*/*.log "$data"/laser-*/*.clf
seed csm-log "$data"/laser-csm-json/*
seed points-csv "$data"/points-csv/* "$data"/laser-csv/*
seed jupedsim-xml "$data"/jupedsim-xml/*
seed menge-xml "$data"/menge-xml/*
seed sumo-poly "$data"/sumo-poly/*
seed barn-world "$data"/barn-world/*
seed rings-json "$data"/earcut-json/*
seed jts-xml "$data"/jts-xml/* "$data"/geos-xml/*
seed opentraj-xml "$data"/opentraj-xml/*
seed graphml "$data"/salzburg-gpl/*.graphml
seed counted-rings "$data"/salzburg-gpl/*.line
seed pslg "$data"/pslg-cdt/*
seed ompl-circles "$data"/ompl/circle_obstacles.txt
seed ompl-grid "$data"/ompl/env*.txt
for yaml in "$data"/ros-map/*/*.yaml; do
  for picture in "$(dirname "$yaml")"/*.pgm "$(dirname "$yaml")"/*.png "$(dirname "$yaml")"/*.bmp; do
    [ ! -f "$picture" ] || ros_seed "$yaml" "$picture"
  done
done
mkdir -p "$out/scenario"
here=$(dirname "$0")
cp "$here"/../../datasets/data/paper/*.json "$out/scenario/"
# What once went wrong is a seed as well.
for folder in "$here"/../corpus/readers/*/; do
  [ ! -d "$folder" ] || { mkdir -p "$out/$(basename "$folder")" && cp "$folder"* "$out/$(basename "$folder")/"; }
done
