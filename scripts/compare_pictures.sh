#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Renders the same scenes with two builds and tells which pictures differ by even a bit: for changes that must not show.
#
#   scripts/compare_pictures.sh BEFORE AFTER [TRACE.rtrace]
#
# BEFORE, AFTER  folders with vkpt and ref_vkpt.so (build/release/bin, or a copy of it)
# TRACE.rtrace   frames of it are rendered, too (`vkpt record vkpt1 -o TRACE.rtrace`)
# VKPT_DATA      the game data (default: the build's own)
# VKPT_ONLY      an extended regular expression: only the cases whose line matches
# VKPT_SUMS      a file that keeps what BEFORE's pictures come to, for the next call
# The exit status is 1 where a picture differs.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
(($# == 2 || $# == 3)) || die "usage: compare_pictures.sh BEFORE AFTER [TRACE.rtrace]"
before=$1 after=$2 trace=${3:-}
for build in "$before" "$after"; do
    [[ -x $build/vkpt && -f $build/ref_vkpt.so ]] || die "$build has no vkpt and ref_vkpt.so"
done
data=${VKPT_DATA:-$build_dir/game}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# A line each: scene and options.
list_cases() {
    local -r start=maps/vkpt1.bsp hall=maps/vkpt1.bsp@0,-384,46,0,90 small="--size 96x64"
    for file in "$root"/shaders/light_samplers/*.glsl; do
        echo "$hall $small --spp 2 --set pt_light_sampler=$(basename "$file" .glsl)"
    done
    for denoiser in off temporal svgf asvgf; do
        echo "$start --size 160x96 --frames 4 --set flt_denoiser=$denoiser --set flt_taa=off"
    done
    for taa in on upscale; do
        echo "$start --size 160x96 --frames 4 --set flt_taa=$taa --set pt_render_scale=60"
    done
    for backend in software query pipeline; do
        echo "$hall $small --frames 3 --set pt_trace=$backend"
        echo "$hall $small --spp 2 --set pt_trace=$backend --set pt_light_sampler=subset_mis"
    done
    for setting in pt_bounces=0 pt_bounces=3 pt_noise=white pt_light_weight=ltc pt_light_point=projected pt_bloom=0 \
        pt_bounce_pixels=all pt_exposure=2 pt_tone_map=none pt_debug_view=normal pt_debug_view=rays; do
        echo "$start $small --frames 2 --set $setting"
    done
    for place in 0,0,46,0,0 300,-200,60,10,135 -300,200,60,5,-45; do
        echo "maps/vkpt1.bsp@$place --size 160x96 --frames 3"
    done
    [[ -z $trace ]] || for frame in 20 120 240; do
        echo "$trace@$frame --size 160x96 --frames 3"
        echo "$trace@$frame --size 160x96 --spp 1"
    done
}

# Sums of the linear picture, and of the shown one where frames follow each other. $1: build, $2...: scene and options.
render() {
    local build=$1 kinds=pfm
    shift
    [[ $* == *--frames* ]] && kinds="pfm png"
    for kind in $kinds; do
        "$build/vkpt" render "$@" --seed 7 --basedir "$data" --module "$build/ref_vkpt.so" -o "$folder/picture.$kind" \
            >"$folder/log" 2>&1 || { cat "$folder/log" >&2; die "$build: vkpt render $* failed"; }
        sha256sum <"$folder/picture.$kind" | cut -c1-32
    done | tr '\n' ' '
}

render_before() {
    local known
    known=$(grep -F -m1 "$* = " "$sums") && { printf '%s' "${known##* = }"; return; }
    known=$(render "$before" "$@") || return 1
    printf '%s = %s\n' "$*" "$known" >>"$sums"
    printf '%s' "$known"
}

sums=${VKPT_SUMS:-$folder/sums}
touch "$sums"
count=0 differing=0
while read -r -a options; do
    [[ "${options[*]}" =~ ${VKPT_ONLY:-.} ]] || continue
    count=$((count + 1))
    old=$(render_before "${options[@]}") && new=$(render "$after" "${options[@]}") || exit 1
    if [[ $old != "$new" ]]; then
        differing=$((differing + 1))
        say "differs: ${options[*]}"
    fi
done < <(list_cases)
say "$count cases, $differing of them differ"
((count > 0 && differing == 0))
