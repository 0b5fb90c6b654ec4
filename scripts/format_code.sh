#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Formats all C++ and GLSL by clang-format 14, with the settings of .clang-format and shaders/.clang-format.
#   scripts/format_code.sh [FOLDER]           rewrites the files below FOLDER (default: the whole source tree)
#   scripts/format_code.sh --check [FOLDER]   names the files that it would change (exit status 1: there are some)
# Other versions of clang-format break lines elsewhere: exit status 77, and nothing is done. Tables of rows (*.def) are left alone.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
read_check_options "$@"
wanted=14
program=clang-format-$wanted
has "$program" || program=clang-format
if ! has "$program" || [[ $("$program" --version) != *"version $wanted."* ]]; then
    warn "clang-format $wanted is needed: sudo apt install clang-format-$wanted"
    exit 77
fi

list_files() {
    find "$top" \( -name .git -o -path "$top/build" -o -path "$top/out" -o -name node_modules \) -prune -o -type f \
        \( -name '*.cpp' -o -name '*.hpp' -o -path '*/shaders/*.h' -o -name '*.comp' -o -name '*.glsl' -o -name '*.rahit' \
        -o -name '*.rchit' -o -name '*.rmiss' \) -print | sort
}

# GLSL is read as C++.
format() {
    local style=file
    case $1 in
    *.comp | *.glsl | *.rahit | *.rchit | *.rmiss) style=file:$root/shaders/.clang-format ;;
    esac
    "$program" --assume-filename="${1%.*}.cpp" --style="$style" <"$1"
}

status=0 count=0
formatted=$(mktemp)
trap 'rm -f "$formatted"' EXIT
while read -r file; do
    count=$((count + 1))
    format "$file" >"$formatted" || die "clang-format failed on $file"
    cmp -s "$formatted" "$file" && continue
    if [[ $check == yes ]]; then
        say "${file#"$top"/} is not formatted: scripts/format_code.sh"
        status=1
    else
        cat "$formatted" >"$file"
    fi
done < <(list_files)
((count > 0)) || die "no code below $top"
exit $status
