#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the Debian packages exactvo, exactvo-verify (where Coq and OCaml are), libexactvo-dev and python3-exactvo in
# build/packages, and judges them: tests/consumer/packages.py does, and lintian where it is installed, for which a warning is
# a failure. Installs nothing. Run again, it builds only what changed.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$root"

folder=build/packages
say "Building $folder, $(compile_jobs) job(s)"
# Debian's folders for libraries are those of the prefix /usr.
cmake --preset release -B "$folder" -DCMAKE_INSTALL_PREFIX=/usr -DEXACTVO_BENCH=OFF -DEXACTVO_EXAMPLES=OFF
cmake --build "$folder" --parallel "$(compile_jobs)"

say "Packing"
rm -f "$folder"/*.deb
(cd "$folder" && cpack -G DEB)

say "Contents"
# 77: what can be judged without changing the root was.
python3 tests/consumer/packages.py --program "$folder/bin/exactvo" --source . "$folder"/*.deb || (($? == 77))

if command -v lintian >/dev/null; then
  say "lintian"
  lintian --fail-on error,warning "$folder"/*.deb
else
  echo "make_packages: lintian is not installed; it has not judged the packages" >&2
fi
ls -l "$folder"/*.deb
