# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by the other scripts: a sane environment, the project's root, and how many compile jobs fit into memory.
set -euo pipefail
# A shell started with an empty environment knows a path but does not pass it on (ccache crashes without one).
export PATH="${PATH:-/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin}"
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# A compile job for each 2 GB of memory that is available (some CGAL units take that much), one at least, and no more
# than there are processors.
compile_jobs() {
  local processors memory_kb by_memory
  processors=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
  by_memory=$((memory_kb / (2 * 1000 * 1000)))
  ((by_memory >= 1)) || by_memory=1
  echo $((by_memory < processors ? by_memory : processors))
}

say() { printf '\n== %s\n' "$*"; }
