#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# scripts/make_gallery.sh --gl3: the engine's own OpenGL 3 renderer shows the gallery's place as docs/gallery has it.
#   gallery_test.sh BUILD_DIR      exit status 77: there is no engine with gl3 here
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
export VKPT_BUILD_DIR=$1 VKPT_CACHE_DIR=$1/tests/engine/cache # which the player's user may write to
. "$root/scripts/lib/common.sh"
. "$root/scripts/lib/engine.sh"
engine=$(find_engine)
[[ -e ${engine%/*}/ref_gl3.so ]] || { echo "no ref_gl3.so beside the engine"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
unset DISPLAY WAYLAND_DISPLAY

VKPT_GALLERY_DIR=$folder "$root/scripts/make_gallery.sh" --gl3 fog || die "no picture was taken"
[[ $(ls "$folder") == fog_gl3.jpg ]] || die "other pictures than the one that was asked for: $(ls "$folder")"
# vkpt compares PNGs only. Clouds and liquids move; another place or another look of the eye has ten times that.
"$VKPT_BUILD_DIR/scripts/contact_sheet" "$folder/now.png" "$folder/fog_gl3.jpg" || die "no picture: $folder/fog_gl3.jpg"
"$VKPT_BUILD_DIR/scripts/contact_sheet" "$folder/kept.png" "$root/docs/gallery/fog_gl3.jpg" || exit 1
"$VKPT_BUILD_DIR/bin/vkpt" diff --json "$folder/kept.png" "$folder/now.png" >"$folder/diff.json" || exit 1
flip=$(sed -nE 's/.*"flip": *([0-9.e-]+).*/\1/p' "$folder/diff.json" | head -n 1)
awk -v flip="${flip:-1}" 'BEGIN { exit !(flip < 0.03) }' || die "the picture differs from docs/gallery/fog_gl3.jpg: flip $flip"
