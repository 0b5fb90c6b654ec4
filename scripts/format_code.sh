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

# list_files NAME-TEST...: those below the folder, as words of find(1) choose them.
list_files() {
    find "$top" \( -name .git -o -path "$top/build" -o -path "$top/out" -o -name node_modules \) -prune -o -type f \( "$@" \) -print0 | sort -z
}
cpp=(-name '*.cpp' -o -name '*.hpp' -o -path '*/shaders/*.h')
glsl=(-name '*.comp' -o -name '*.glsl' -o -name '*.rahit' -o -name '*.rchit' -o -name '*.rmiss') # clang-format takes it for C++

# format STYLE NAME-TEST...: all of these files by one clang-format, which takes long to start. What it would change, it names with
# --dry-run, in lines "FILE:LINE:COLUMN: warning: ...".
format() {
    list_files "${@:2}" | xargs -0 -r "$program" "$action" --style="$1" 2>&1
}

action=-i
[[ $check == no ]] || action=--dry-run
[[ -n $(list_files "${cpp[@]}" -o "${glsl[@]}" | head -c 1 | tr '\0' x) ]] || die "no code below $top"
said=$(format file "${cpp[@]}" && format "file:$root/shaders/.clang-format" "${glsl[@]}") || die "clang-format failed:
$said"
found=$(sed -nE "s,^(.+):[0-9]+:[0-9]+: warning: code should be clang-formatted.*,\1,p" <<<"$said" | sort -u)
[[ -n $found ]] || exit 0
while read -r file; do
    say "${file#"$top"/} is not formatted: scripts/format_code.sh"
done <<<"$found"
exit 1
