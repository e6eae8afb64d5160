#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what the project needs and is missing, on Debian and its relatives; elsewhere prints what is needed and stops.
# Nothing missing: says so and changes nothing. `install-dependencies.sh program`: what the libraries, the program and the
# benchmarks need, without what only tests and the site need; `install-dependencies.sh python`: that and the Python package.
set -euo pipefail
export PATH="${PATH:-/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin}"

for_program=(
  g++ cmake ninja-build ccache git ca-certificates                  # to build
  libcgal-dev libgmp-dev libmpfr-dev libeigen3-dev                  # exact geometry, linear algebra
  libboost-dev libboost-graph-dev libtbb-dev libhwy-dev             # ODE, graphs, threads, SIMD
  libcli11-dev nlohmann-json3-dev libfmt-dev libssl-dev zlib1g-dev  # command line, JSON, text, SHA-256, pages
  libgdal-dev libsqlite3-dev libyaml-cpp-dev libpugixml-dev         # files in and out
  libopenmpi-dev openmpi-bin                                        # a batch over several machines
  libcpp-httplib-dev pkg-config                                     # exactvo serve
  gnuplot-nox fonts-dejavu-core                                     # figures
  libbenchmark-dev libglpk-dev                                      # benchmarks, and a solver to compare with
)
for_python=(
  python3-dev pybind11-dev python3-numpy python3-matplotlib         # the package, and what its plots are drawn with
  python3-venv python3-setuptools python3-wheel                     # pip install . without an index
)
for_tests=(
  libgtest-dev libgmock-dev librapidcheck-dev libvalijson-dev       # tests
  mold                                                              # links them faster; without, the usual linker does
  libgeographiclib-dev                                              # geodesics, to judge projections by
  chromium chromium-driver python3-selenium                         # tests of the explorer's page in a browser
  python3-pytest mypy python3-pandas python3-shapely                # tests of the Python package
  doxygen pandoc                                                    # the site
  coq ocaml ocaml-findlib libzarith-ocaml-dev                       # the proven checkers, exactvo-verify; without, all else is built
)
case "${1:-all}" in
  all) packages=("${for_program[@]}" "${for_python[@]}" "${for_tests[@]}") ;;
  program) packages=("${for_program[@]}") ;;
  python) packages=("${for_program[@]}" "${for_python[@]}") ;;
  *)
    echo "install-dependencies: found '$1', expected 'program', 'python' or nothing" >&2
    exit 2
    ;;
esac

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  {
    echo "install-dependencies: this system has no apt. Install these (named as in Debian 12), then run the build by hand:"
    printf '  %s\n' "${packages[@]}"
  } >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || status=absent
  [[ $status == installed ]] || missing+=("$package")
done

if ((${#missing[@]} == 0)); then
  echo "install-dependencies: all ${#packages[@]} packages are installed"
  exit 0
fi

if ((EUID == 0)); then
  as_root=(env)
elif command -v sudo >/dev/null; then
  as_root=(sudo env)
else
  echo "install-dependencies: neither root nor sudo; as root, run:" >&2
  echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 1
fi

echo "install-dependencies: installing ${missing[*]}"
"${as_root[@]}" apt-get update
"${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "${missing[@]}"
