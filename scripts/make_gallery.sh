#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Makes the pictures of docs/gallery.md anew: our own map, and the scenes of docs/gallery/looks.map.
#   scripts/make_gallery.sh [NAME]...     all, or those that are named
# Takes vkpt, vkpt_map, the module and the game data from build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/release
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/baseq2/maps"
cp -r "$build/game/baseq2/." "$work/baseq2/"
"$build/tools/map_compiler/vkpt_map" docs/gallery/looks.map -o "$work/baseq2/maps/looks.bsp" \
    --textures "$build/game/baseq2/textures"
cp docs/gallery/looks.lights docs/gallery/looks.mat "$work/baseq2/maps/"

# NAME SCENE [vkpt's options]
picture() {
    local name=$1 scene=$2
    shift 2
    if [ ${#wanted[@]} -gt 0 ] && [[ " ${wanted[*]} " != *" $name "* ]]; then
        return
    fi
    "$build/bin/vkpt" render "$scene" --basedir "$work" --size 384x216 --frames 48 "$@" -o "docs/gallery/$name.png"
}
# The same, as an average of many samples.
photograph() {
    local name=$1 scene=$2
    shift 2
    if [ ${#wanted[@]} -gt 0 ] && [[ " ${wanted[*]} " != *" $name "* ]]; then
        return
    fi
    "$build/bin/vkpt" render "$scene" --basedir "$work" --size 384x216 --spp 400 "$@" -o "docs/gallery/$name.png"
}
wanted=("$@")

picture water maps/looks.bsp@-330,-230,120,40,75
picture slime_lava maps/looks.bsp@60,-330,130,22,80
picture glass maps/looks.bsp@-200,170,90,12,70
picture under_water maps/vkpt1.bsp@-600,-60,-100,10,90
picture god_rays maps/looks.bsp@330,215,40,-14,80 --set pt_fog=0.0015 --set pt_fog_color="0.05 0.05 0.06" --set pt_god_rays=2
picture fog maps/looks.bsp@60,-480,150,15,90 --set pt_fog=0.002 --set pt_fog_height=60
picture physical_sky maps/vkpt1.bsp@0,520,200,-5,90 --set pt_sky=physical --set pt_sky_azimuth=120
picture flashlight maps/vkpt1.bsp@-440,100,60,10,-135 --set pt_flashlight=1 --set pt_emission_scale=0.02
picture wipe maps/vkpt1.bsp --set pt_wipe=0.5
photograph lens maps/vkpt1.bsp@0,-384,46,0,90 --set pt_aperture=10 --set pt_focus=190
