#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What ./play removes, writes over or gives to another user is what it made itself; whatever folder it is pointed at.
# shellcheck disable=SC2034,SC2317  # the functions below replace those of the scripts
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
folder=$(mktemp -d)
chmod 755 "$folder"
trap 'rm -rf "$folder"' EXIT
. "$root/scripts/lib/common.sh"
. "$root/scripts/lib/engine.sh"
. "$root/scripts/lib/play.sh"
failures=0
expect() { # NAME COMMAND...
    "${@:2}" >"$folder/output" 2>&1 && return 0
    printf 'FAILED: %s\n%s\n' "$1" "$(cat "$folder/output")"
    failures=$((failures + 1))
}
refuses() { ! ("$@"); }

# Pictures: theirs stay, ours of the last time go.
out=$folder/theirs
mkdir "$out"
echo theirs >"$out/frame_of_a_door.png"
expect "somebody's frame: refused" refuses check_out_dir "$out"
expect "a word that helps" test "$(grep -c 'did not write it.*--out' "$folder/output")" = 1
rm "$out/frame_of_a_door.png"
ln -s /dev/null "$out/contact_sheet.png"
expect "somebody's link: refused" refuses check_out_dir "$out"
rm "$out/contact_sheet.png"

build_dir=$folder/build
log_dir=$folder/log
capture_path=$folder/capture
mkdir -p "$build_dir/scripts" "$log_dir" "$capture_path"
# shellcheck disable=SC2016
printf '#!/bin/sh\necho "$@" >"$1"\n' >"$build_dir/scripts/contact_sheet"
chmod 755 "$build_dir/scripts/contact_sheet"
has() { [[ $1 != ffmpeg ]] && command -v "$1" >/dev/null 2>&1; }
for number in 000001 000002 000003; do echo "$number" >"$capture_path/frame$number.png"; done
echo notes >"$out/notes.txt"
expect "pictures" collect_pictures "$out" 10
expect "all are there" test -s "$out/frame000003.png" -a -s "$out/contact_sheet.png"
rm "$capture_path/frame000003.png"
expect "our own pictures are no hindrance" check_out_dir "$out"
expect "pictures again" collect_pictures "$out" 10
expect "the earlier ones are gone" test ! -e "$out/frame000003.png"
expect "the newer ones are there" test -s "$out/frame000002.png"
expect "what is theirs stays" test "$(cat "$out/notes.txt")" = notes
# A list that names more than pictures is not believed.
printf '%s\n' ../notes.txt notes.txt /etc/passwd >>"$out/$pictures_list"
clear_out_dir "$out"
expect "a list with other names" test -e "$out/notes.txt"

# Owners: as root, only what we made changes hands.
if is_root; then
    player_uid=65534 player_gid=65534
    mkdir -p "$folder/system/etc"
    echo secret >"$folder/system/etc/file"
    expect "a folder of the system is not given away" refuses give_folder "$folder/system"
    expect "nor what lies in it" test "$(stat -c %u "$folder/system/etc/file")" = 0
    ln -s "$folder/system" "$folder/link"
    expect "nor what a link leads to" refuses give_folder "$folder/link"
    expect "nor what a link leads to" test "$(stat -c %u "$folder/system")" = 0
    expect "a new folder" give_folder "$folder/new/cache"
    expect "a new folder is the player's" test "$(stat -c %u "$folder/new/cache")" = 65534
    ln -s "$folder/system/etc/file" "$folder/new/cache/planted"
    : >"$folder/new/cache/by_root"
    expect "the same a second time" give_folder "$folder/new/cache"
    expect "what root put there is given, too" test "$(stat -c %u "$folder/new/cache/by_root")" = 65534
    expect "links in it are not followed" test "$(stat -c %u "$folder/system/etc/file")" = 0
else
    player_uid=$(id -u) player_gid=$(id -g)
    expect "a new folder" give_folder "$folder/new/cache"
fi
((failures == 0)) && echo "nothing of others was touched"
((failures == 0))
