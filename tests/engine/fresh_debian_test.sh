#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# scripts/try_fresh_debian.sh, which takes hours: that it says what it wants, and touches nothing before.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
failures=0

expect() {
    local status=$1 pattern=$2 output got=0
    shift 2
    output=$("$@" 2>&1 </dev/null) || got=$?
    [[ $got -eq $status ]] && grep -qE -- "$pattern" <<<"$output" && return 0
    echo "FAILED: $* ended with $got instead of $status, or did not say '$pattern': $output"
    failures=$((failures + 1))
}

script=$root/scripts/try_fresh_debian.sh
bash -n "$script" || failures=1
expect 0 'Usage: .*SUITE' "$script" --help
expect 2 'which suite' "$script"
expect 2 "not 'buster'" "$script" buster
expect 2 "no part 'nonsense'" "$script" --only nonsense bookworm
expect 2 'unknown option' "$script" --nonsense
# An ordinary user may not look into root's home, where the scripts may be.
scripts=$(mktemp -d)
trap 'rm -rf "$scripts"' EXIT
cp -r "$root/scripts" "$scripts/" && chmod -R a+rX "$scripts"
as_user=()
[[ $(id -u) -ne 0 ]] || as_user=(setpriv --reuid=65534 --clear-groups)
expect 1 'need root' ${as_user[@]+"${as_user[@]}"} "$scripts/scripts/try_fresh_debian.sh" bookworm
((failures == 0))
