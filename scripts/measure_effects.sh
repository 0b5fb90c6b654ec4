#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What effects cost where they fill the view: the table of docs/benchmarks.md.
#
#   scripts/measure_effects.sh [NAME]...     all, or those that are named
#
# Each is measured with and without it in turns, from the places of docs/gallery.md or the start of our map: liquids, glass,
# suns, spots and pictures of what glows against the same map without them, the rest by its setting. At the end, medians over
# the turns. Takes vkpt, vkpt_map, the module and the game data from the build, for particles and the player's own body the
# engine, too, and half an hour. Not here, as `vkpt bench` has no window and no player: HDR, photo mode, a replay that is shown.
# VKPT_BUILD_DIR       as in ./play
# VKPT_EFFECT_ROUNDS   turns (3);  VKPT_EFFECT_FRAMES  frames of each (24);  VKPT_EFFECT_SIZE  their size (640x360)
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
cd "$root"
. scripts/lib/measure.sh
wanted=("$@")
rounds=${VKPT_EFFECT_ROUNDS:-3} frames=${VKPT_EFFECT_FRAMES:-24} size=${VKPT_EFFECT_SIZE:-640x360}

# frame_time SCENE [NAME=VALUE]...: the median frame in ms.
frame_time() {
    local scene=$1 setting
    local -a sets=()
    shift
    for setting in "$@"; do sets+=(--set "$setting"); done
    "$build/bin/vkpt" bench "$scene" --basedir "$work" --size "$size" --frames "$frames" ${sets[@]+"${sets[@]}"} \
        | awk '$1 == "frame" { print $2 }'
}

# copy_map NAME [LINE]...: our map once more, without a file of materials; the lines are its NAME.lights.
copy_map() {
    local name=$1
    shift
    cp "$work/baseq2/maps/vkpt1.bsp" "$work/baseq2/maps/$name.bsp"
    (($# == 0)) || printf '%s\n' "$@" >"$work/baseq2/maps/$name.lights"
}

# set_material MAP PREFIX ATTRIBUTE...: of our textures whose names begin so.
set_material() {
    local map=$1 prefix=$2 file
    shift 2
    for file in "$work/baseq2/textures/vkpt/$prefix"*.wal; do
        printf 'vkpt/%s:\n    %s\n' "$(basename "$file" .wal)" "$*"
    done >"$work/baseq2/maps/$map.mat"
}

# write_bumps FILE.tga: a normal map of 64 x 64 texels, waves of 8.
write_bumps() {
    {
        printf '\0\0\2\0\0\0\0\0\0\0\0\0\100\0\100\0\30\40'
        LC_ALL=C awk 'BEGIN { for (y = 0; y < 64; y++) for (x = 0; x < 64; x++)
            printf "%c%c%c", 240, 128 + int(40 * sin(y * 0.785)), 128 + int(40 * sin(x * 0.785)) }'
    } >"$1"
}

# write_spots: entities of 16 spots under the ceiling of our map's hall.
write_spots() {
    local x y
    for x in -210 -70 70 210; do
        for y in -400 -200 0 200; do
            echo "{ \"classname\" \"light\" \"origin\" \"$x $y 200\" \"light\" \"2000\" \"_spotangle\" \"0 -90\" \"_cone\" \"30\" }"
        done
    done
}

# record_shots: a trace of our map with floors that are mirrors. The player shoots through the hall with the weapon of most
# particles (frames 15 to 55), then looks at the floor.
record_shots() {
    copy_map mirror
    set_material mirror floor_ kind CHROME
    printf '%s\n' "give all" "use railgun" wait_60 +attack wait_60 wait_60 wait_60 wait_60 -attack +lookdown wait_20 -lookdown \
        wait_60 wait_60 wait_60 wait_60 stop quit >"$work/route.cfg"
    scripts/record_demo.sh "$work/route.cfg" "$work/shots.dm2" "$work/baseq2/maps/mirror.bsp" >&2 \
        && "$build/bin/vkpt" record "$work/shots.dm2" --timedemo --basedir "$work" -o "$work/shots.rtrace" >&2
}

# Maps that lack what the scene's map has, for effects without a setting.
declare -A bare_maps=([looks]=bare [sunny]=sunless [spots]=vkpt1 [glow]=vkpt1)

# effect NAME SCENE [NAME=WITHOUT,WITH]... [-- NAME=VALUE...]: those behind -- count for both. Without a setting to turn off,
# the scene is compared with the map of bare_maps.
effect() {
    local name=$1 with=$2 without=$2 map=${2#maps/} round setting values ms_without ms_with
    local -a off=() on=()
    shift 2
    is_wanted "$name" || return 0
    map=${map%%.*}
    [[ ${1:---} != -- ]] || without=${with/$map.bsp/${bare_maps[$map]}.bsp}
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
make_bare_map "$work"
copy_map bumps
set_material bumps "" texture_normals textures/vkpt/bumps
write_bumps "$work/baseq2/textures/vkpt/bumps.tga"
copy_map glow
set_material glow wall_ texture_emissive textures/vkpt/lamp_warm
mapfile -t spots < <(write_spots)
copy_map spots "${spots[@]}"
for map in sunny sunless; do
    cp "$work/baseq2/maps/looks.bsp" "$work/baseq2/maps/$map.bsp"
    cp docs/gallery/looks.mat "$work/baseq2/maps/$map.mat"
done
cp docs/gallery/looks.lights "$work/baseq2/maps/sunny.lights"
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
effect normal_maps maps/bumps.bsp pt_bump_scale=0,1
effect emissive_maps maps/glow.bsp
effect map_sun "${gallery_scenes[fog]/looks/sunny}"
effect map_spots maps/spots.bsp
effect show_lights maps/vkpt1.bsp pt_show_lights=0,1
effect keep_replay maps/vkpt1.bsp pt_replay_seconds=0,60
if is_wanted particles player_body; then
    record_shots || die "no shots were recorded"
    effect particles "$work/shots.rtrace@20" gl3_particle_size=0,40
    effect player_body "$work/shots.rtrace@60" pt_player_body=0,1
fi
awk "$awk_median"'
    { if (!n[$1]++) order[++names] = $1
      without[$1] = without[$1] " " $2; with[$1] = with[$1] " " $3; ratio[$1] = ratio[$1] " " $3 / $2 }
    END { print "| effect | without, ms | with | ratio |\n|---|---|---|---|"
        for (i = 1; i <= names; i++) { k = order[i]
            printf "| %s | %.0f | %.0f | x%.2f |\n", k, median(without[k], n[k]), median(with[k], n[k]), median(ratio[k], n[k]) } }' \
    "$work/times"
