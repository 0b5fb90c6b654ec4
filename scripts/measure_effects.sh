#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What effects cost where they fill the view: the table of docs/benchmarks.md.
#
#   scripts/measure_effects.sh [NAME]...     all, or those that are named
#
# Each is measured with and without it in turns, from the places of docs/gallery.md: liquids and glass against the same map
# without them, the rest by its setting. At the end, medians over the turns. Takes vkpt, vkpt_map, the module and the game
# data from the build, and some ten minutes.
# VKPT_BUILD_DIR       as in ./play
# VKPT_EFFECT_ROUNDS   turns (3);  VKPT_EFFECT_FRAMES  frames of each (24);  VKPT_EFFECT_SIZE  their size (640x360)
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
cd "$root"
. scripts/lib/common.sh
. scripts/lib/gallery.sh
[[ ${1:-} != -h && ${1:-} != --help ]] || { sed -n '3,11s/^# \?//p' "$0"; exit 0; }
build=$build_dir
wanted=" $* "
rounds=${VKPT_EFFECT_ROUNDS:-3} frames=${VKPT_EFFECT_FRAMES:-24} size=${VKPT_EFFECT_SIZE:-640x360}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# bare_map NAME TEXTURE...: looks.map without the brushes of these textures.
bare_map() {
    local name=$1
    shift
    awk -v textures=" $* " '
        /^\{/ { depth++; if (depth == 2) { brush = ""; wanted = 1 } }
        depth == 2 { brush = brush $0 "\n"; if (index(textures, " " $16 " ")) wanted = 0 }
        depth != 2 { print }
        /^\}/ { if (depth == 2 && wanted) printf "%s", brush; depth-- }' docs/gallery/looks.map >"$work/$name.map"
    "$build/tools/map_compiler/vkpt_map" "$work/$name.map" -o "$work/baseq2/maps/$name.bsp" --textures "$build/game/baseq2/textures"
    cp docs/gallery/looks.lights "$work/baseq2/maps/$name.lights"
    cp docs/gallery/looks.mat "$work/baseq2/maps/$name.mat"
}

# frame_time SCENE [NAME=VALUE]...: the median frame in ms.
frame_time() {
    local scene=$1 setting
    local -a sets=()
    shift
    for setting in "$@"; do sets+=(--set "$setting"); done
    "$build/bin/vkpt" bench "$scene" --basedir "$work" --size "$size" --frames "$frames" ${sets[@]+"${sets[@]}"} \
        | awk '$1 == "frame" { print $2 }'
}

# effect NAME SCENE [NAME=WITHOUT,WITH]... [-- NAME=VALUE...]: those behind -- count for both. A scene of looks.map without a setting
# to turn off is compared with the bare map.
effect() {
    local name=$1 with=$2 without=$2 round setting values ms_without ms_with
    local -a off=() on=()
    shift 2
    [[ $wanted == "  " || $wanted == *" $name "* ]] || return 0
    [[ ${1:---} != -- ]] || without=${with/looks.bsp/bare.bsp}
    while (($#)) && [[ $1 != -- ]]; do
        setting=${1%%=*} values=${1#*=}
        off+=("$setting=${values%%,*}") on+=("$setting=${values#*,}")
        shift
    done
    (($# == 0)) || { shift; off+=("$@") on+=("$@"); }
    for ((round = 0; round < rounds; round++)); do
        ms_without=$(frame_time "$without" ${off[@]+"${off[@]}"}) && ms_with=$(frame_time "$with" ${on[@]+"${on[@]}"}) \
            || die "$name was not measured"
        echo "$name $ms_without $ms_with" | tee -a "$work/times" >&2
    done
}

make_gallery_data "$work"
bare_map bare vkpt/water vkpt/slime vkpt/lava vkpt/lamp_cyan vkpt/lamp_green vkpt/lamp_magenta
effect water "${gallery_scenes[water]}" -- pt_caustics=0
effect caustics "${gallery_scenes[water]}" pt_caustics=0,1
effect under_water "${gallery_scenes[under_water]}" pt_water_density=0,0.5
effect slime_and_lava "${gallery_scenes[slime_lava]}"
effect glass "${gallery_scenes[glass]}"
effect fog "${gallery_scenes[fog]}" pt_fog=0,0.002 -- pt_fog_height=60 pt_god_rays=0
effect god_rays "${gallery_scenes[god_rays]}" pt_god_rays=0,2 -- pt_fog=0.0015
effect physical_sky "${gallery_scenes[physical_sky]}" pt_sky=cube,physical
effect flashlight "${gallery_scenes[flashlight]}" pt_flashlight=0,1
effect screen "${gallery_scenes[screens]}" pt_cameras=0,1
effect anisotropy maps/vkpt1.bsp r_anisotropic=0,4
effect sharpening maps/vkpt1.bsp flt_sharpen=0,1
effect bloom maps/vkpt1.bsp pt_bloom=0,0.04
effect classic_light maps/vkpt1.bsp pt_wipe=0,1
awk 'function median(list, count,   i, j, held, value) {
        split(list, value, " ")
        for (i = 2; i <= count; i++)
            for (j = i; j > 1 && value[j - 1] + 0 > value[j] + 0; j--) { held = value[j]; value[j] = value[j - 1]; value[j - 1] = held }
        return count % 2 ? value[(count + 1) / 2] : (value[count / 2] + value[count / 2 + 1]) / 2
    }
    { if (!n[$1]++) order[++names] = $1
      without[$1] = without[$1] " " $2; with[$1] = with[$1] " " $3; ratio[$1] = ratio[$1] " " $3 / $2 }
    END { print "| effect | without, ms | with | ratio |\n|---|---|---|---|"
        for (i = 1; i <= names; i++) { k = order[i]
            printf "| %s | %.0f | %.0f | x%.2f |\n", k, median(without[k], n[k]), median(with[k], n[k]), median(ratio[k], n[k]) } }' \
    "$work/times"
