#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# A function fits a screen: names those whose body has more than 60 lines. By the layout that clang-format gives: a body's
# braces have lines of their own.
#   scripts/check_functions.sh [FOLDER]   of the source tree at FOLDER (default: this one); exit status 1: there are some
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
top=${1:-$root}
[[ -d $top ]] || die_usage "$top is not a folder"

cd "$top" || exit 1
found=$(find . \( -name .git -o -path ./build -o -path ./out \) -prune -o -type f \
    \( -name '*.[ch]pp' -o -name '*.c' -o -name '*.h' -o -name '*.comp' -o -name '*.glsl' \) -print0 \
    | sort -z | xargs -0 awk -v most=60 '
        FNR == 1 { start = 0 }
        !start && /^ *\{$/ { start = FNR; indent = index($0, "{") - 1; head = last }
        start && index($0, "}") == indent + 1 {
            if (FNR - start - 1 > most) print FILENAME ":" start ": " FNR - start - 1 " lines: " head
            start = 0
        }
        { last = $0; sub(/^ */, "", last) }')
[[ -z $found ]] && exit 0
say "$found"
exit 1
