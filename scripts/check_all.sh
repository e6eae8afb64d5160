#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the long checks of scripts/checks.txt: sanitizers, fuzzers, campaigns, faults. Interrupt it and start it again: a check
# that passed on the same tree is not repeated.
#
#   scripts/check_all.sh [--list] [--only REGEX] [--again] [--out DIR] [--table FILE]
#
#   --list        print the checks with their minutes and last results, and run none
#   --only REGEX  take the checks whose name matches
#   --again       repeat what has passed too
#   --out DIR     logs and results (default: out/checks)
#   --table FILE  the checks to run (default: scripts/checks.txt)
#
# Exit status: 0 if every check that was asked for has passed, 1 if one failed or did not run, 2 for a wrong option.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
list=no again=no only=. out=$root/out/checks table=$root/scripts/checks.txt

refuse() { printf 'check_all.sh: error: %s\n' "$*" >&2; exit 2; }

while (($#)); do
  case $1 in
    --list) list=yes ;;
    --again) again=yes ;;
    --only | --out | --table)
      (($# > 1)) || refuse "$1 needs a value"
      printf -v "${1#--}" %s "$2"
      shift ;;
    --help) sed -n '3,/^source/ { /^source/d; s/^# \{0,1\}//; p }' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) refuse "found '$1', expected --list, --only, --again, --out or --table" ;;
  esac
  shift
done
[[ -r $table ]] || refuse "cannot read the table $table"
# grep's status is 2 for a pattern that it does not understand.
grep -qE -- "$only" /dev/null 2> /dev/null || (($? < 2)) || refuse "'$only' is not a regular expression"
out=$(realpath -m "$out")
mkdir -p "$out"

# A result counts for the tree that it was made on: the commit and what was changed since.
tree_now() {
  { git -C "$root" rev-parse HEAD && git -C "$root" diff HEAD && git -C "$root" status --porcelain; } 2> /dev/null |
    sha256sum | cut -c -16
}

declare -a names=() minutes=() commands=()
while IFS='|' read -r name time command; do
  name=$(echo $name) time=$(echo $time) command=${command# }
  [[ -n $name && $name != \#* ]] || continue
  [[ $name =~ ^[a-z0-9.-]+$ && $time =~ ^[0-9]+$ && -n $command ]] ||
    refuse "$table: found '$name | $time | $command', expected NAME | MINUTES | COMMAND"
  if [[ $name =~ $only ]]; then names+=("$name") minutes+=("$time") commands+=("$command"); fi
done < "$table"
((${#names[@]})) || refuse "no check of $table matches '$only'"

# A result file has one line: tree, exit status, seconds.
result_of() {
  local at status seconds
  [[ -r $out/$1.result ]] && read -r at status seconds < "$out/$1.result" || { echo "not run"; return; }
  if [[ $at != "$tree" ]]; then echo "another tree"
  elif ((status == 0)); then echo passed
  else echo "FAILED ($status)"; fi
}

print_table() {
  local i seconds
  echo '| check | result | minutes (expected) | last line |'
  echo '| --- | --- | --- | --- |'
  for i in "${!names[@]}"; do
    seconds=$(cut -d ' ' -f 3 "$out/${names[i]}.result" 2> /dev/null || true)
    printf '| %s | %s | %s (%s) | %s |\n' "${names[i]}" "$(result_of "${names[i]}")" \
      "${seconds:+$(((seconds + 30) / 60))}" "${minutes[i]}" \
      "$(tail -n 1 "$out/${names[i]}.log" 2> /dev/null | tr '|' '/' | cut -c -100)"
  done
}

total=0
tree=$(tree_now)
for i in "${!names[@]}"; do
  [[ $again = no && $(result_of "${names[i]}") = passed ]] || ((total += minutes[i])) || true
done
if [[ $list = yes ]]; then
  print_table
  echo "left: about $total minutes"
  exit 0
fi

trap 'echo; print_table | tee "$out/table.md"; exit 130' INT TERM
say "${#names[@]} checks, about $total minutes left; logs in $out"
failed=0
for i in "${!names[@]}"; do
  name=${names[i]}
  [[ $again = no && $(result_of "$name") = passed ]] && continue
  say "$name (about ${minutes[i]} minutes): ${commands[i]}"
  started=$SECONDS status=0
  (cd "$root" && EXACTVO_JOBS=$(compile_jobs) bash -c "set -euo pipefail; ${commands[i]}") > "$out/$name.log" 2>&1 < /dev/null ||
    status=$?
  echo "$tree $status $((SECONDS - started))" > "$out/$name.result"
  ((status == 0)) || { failed=1; tail -n 5 "$out/$name.log"; }
done
print_table | tee "$out/table.md"
exit $failed
