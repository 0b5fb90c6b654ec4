#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Makes the pictures of docs/gallery.md anew: our own map, and the scenes of docs/gallery/looks.map.
#   scripts/make_gallery.sh [--gl3] [NAME]...     all, or those that are named
#   --gl3   those of the engine's own OpenGL 3 renderer, from the same places: NAME_gl3.jpg
# VKPT_GALLERY_DIR: where to, if not docs/gallery.
# Takes vkpt, vkpt_map, the module and the game data from the build. For `body` and for --gl3 the real engine runs under
# Xvfb, with gl3 on Mesa's software OpenGL (libgl1-mesa-dri).
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/lib/gallery.sh
build=${VKPT_BUILD_DIR:-build/release}
out=${VKPT_GALLERY_DIR:-docs/gallery}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=384x216
renderer=ours
[[ ${1:-} != --gl3 ]] || { renderer=gl3; shift; }
wanted=("$@")

# entities MAP X Y Z: what is in the map, as vkpt shows it (without items and monsters), with the player's
# start at that place and no gravity. Lump 0 of a BSP is the entities' text.
entities() {
    local file=$work/baseq2/maps/$1.bsp begin length
    shift
    read -r begin length < <(od -An -tu4 -j8 -N8 "$file")
    head -c "$((begin + length))" "$file" | tail -c "$length" | tr -d '\0' \
        | awk -v RS='}' '/classname/ && !/"classname"[ \t]+"(info_player|item_|weapon_|ammo_|monster_|misc_)/ {
            sub(/"worldspawn"/, "&\n\"gravity\" \"0\"")
            print $0 "}"
        }'
    printf '{\n"classname" "info_player_start"\n"origin" "%s %s %s"\n}\n' "$@"
}

# A PCX of 2 x 2 pixels, all transparent.
make_empty_pcx() {
    printf '\x0a\x05\x01\x08\x00\x00\x00\x00\x01\x00\x01\x00'
    head -c 53 /dev/zero
    printf '\x01\x02\x00'
    head -c 60 /dev/zero
    printf '\xc2\xff\xc2\xff\x0c'
    head -c 768 /dev/zero
}

# No cvar of the engine hides the status bar.
hide_status_bar() {
    local pcx pics=$work/baseq2/pics
    make_empty_pcx >"$work/empty.pcx"
    for pcx in "$pics"/{num,anum,i,a,w}_*.pcx; do
        cp "$work/empty.pcx" "$pcx"
        rm -f "${pcx%.pcx}.png"
    done
}

# photograph RENDERER NAME SCENE PICTURE [ENGINE'S ARGUMENT]...: the real engine with gl3 or vkpt. Our game module turns
# the player's view, as a start has no pitch, and swims just so much that they do not sink in water.
photograph() {
    local renderer=$1 scene=$3 picture=$4 map x y z pitch yaw run=$work/run_$2
    shift 4
    IFS=' ' read -r map x y z pitch yaw <<<"$(echo "${scene#maps/}" | sed 's/\.bsp@\?/ /; s/,/ /g')"
    mkdir -p "$run/files/maps" "$run/files/walks"
    printf 'look %s %s\ninput 60 up 1\n' "$pitch" "$yaw" >"$run/files/walks/gallery.txt"
    entities "$map" "$x" "$y" "$((z - 22))" >"$run/files/maps/$map.ent"
    cat >"$run/files/photograph.cfg" <<CFG
alias wait_8 "wait;wait;wait;wait;wait;wait;wait;wait"
alias wait_64 "wait_8;wait_8;wait_8;wait_8;wait_8;wait_8;wait_8;wait_8"
wait_64
cmd walk gallery
wait_8
teleport $x $y $((z - 22))
wait_64
wait_64
screenshot ${picture##*.} 92
wait_8
quit
CFG
    chmod -R a+rX "$work"
    LIBGL_ALWAYS_SOFTWARE=1 VKPT_RENDERER=$renderer VKPT_GAME=vkpt VKPT_DATA=$work timeout 1200 scripts/run_engine.sh "$run" "$size" \
        +set sv_entfile 1 +set con_notifytime 0 +set crosshair 0 +set deathmatch 0 +set maxclients 1 "$@" \
        +map "$map" +exec photograph.cfg >"$run/log" 2>&1 || { tail -n 20 "$run/log" >&2; return 1; }
    if grep -q '^Retrying with' "$run/home/.yq2/vkpt/qconsole.log"; then
        echo "$renderer did not start here; its console:" >&2
        sed -n '/ref_'"$renderer"'/,/^Retrying with/p' "$run/home/.yq2/vkpt/qconsole.log" >&2
        return 1
    fi
    install -m 644 "$run"/home/.yq2/vkpt/scrnshot/*."${picture##*.}" "$out/$picture"
    echo "$out/$picture"
}

# picture NAME [vkpt's options]: the scene of gallery_scenes by this name.
picture() {
    local name=$1 scene=${gallery_scenes[$1]}
    shift
    is_wanted "$name" || return 0
    if [ "$renderer" = gl3 ]; then
        photograph gl3 "$name" "$scene" "${name}_gl3.jpg" +set cl_gun 0
        return
    fi
    "$build/bin/vkpt" render "$scene" --basedir "$work" --size "$size" "$@" -o "$out/$name.png"
}

make_gallery_data "$work"
[ "$renderer" = ours ] || hide_status_bar
frames=(--frames 48) samples=(--spp 400)
picture water "${frames[@]}"
picture slime_lava "${frames[@]}"
picture glass "${frames[@]}"
picture under_water "${frames[@]}"
picture god_rays "${frames[@]}" --set pt_fog=0.0015 --set pt_fog_color="0.05 0.05 0.06" --set pt_god_rays=2
picture fog "${frames[@]}" --set pt_fog=0.002 --set pt_fog_height=60
picture physical_sky "${frames[@]}" --set pt_sky=physical --set pt_sky_azimuth=120
picture flashlight "${frames[@]}" --set pt_flashlight=1 --set pt_emission_scale=0.02
picture wipe "${frames[@]}" --set pt_wipe=0.5
[ "$renderer" = gl3 ] || picture screens "${frames[@]}" # gl3 has no cameras
picture lens "${samples[@]}" --set pt_aperture=10 --set pt_focus=190
# The engine's: what it does not send is the player's own body.
if is_wanted body && [ "$renderer" = gl3 ]; then
    photograph gl3 body "${gallery_scenes[body]}" body_gl3.jpg
elif is_wanted body; then
    hide_status_bar
    photograph vkpt body "${gallery_scenes[body]}" body.png +set pt_render_scale 100 +set pt_target_ms 0
fi
