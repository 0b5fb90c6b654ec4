#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# How clean the live picture is while a player walks: the tables of walks in docs/notes/denoiser.md.
#
#   scripts/measure_motion.sh OUT MAP.bsp...
#
# In each map the engine records a player that wanders for twelve seconds (the game module's `walk explore`), and a trace of it
# is made at 60 frames a second. Of some of its frames the live picture, after the 24 frames before it, is compared with the
# converged one of the same frame. OUT keeps traces, converged pictures and OUT/motion.csv, so that a second run with another
# module or other settings measures the same. At the end, a line for each map: means over its frames.
# VKPT_BUILD_DIR       as in ./play
# VKPT_LIVE            more arguments of vkpt render for the live pictures, such as "--module OTHER.so --set flt_denoiser=svgf"
# VKPT_MOTION_FRAMES   which frames (150 240 330 420 510 600);  VKPT_MOTION_SPP  samples of the converged pictures (256)
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
help_if_asked "$@"
(($# >= 2)) || die_usage "a folder for the results and a map are needed"
mkdir -p "$1/base/baseq2/maps" || die "cannot write to $1"
out=$(cd "$1" && pwd)
shift
vkpt=$build_dir/bin/vkpt
read -ra live <<<"${VKPT_LIVE:-}"
read -ra frames <<<"${VKPT_MOTION_FRAMES:-150 240 330 420 510 600}"
size=320x180 before=24 csv=$out/motion.csv
echo map,frame,rel_mse,mean_difference,flip,specks >"$csv"

record_walk() { # MAP.bsp TRACE
    local demo=${2%.rtrace}.dm2 second
    { echo "walk explore 13 1"; for second in {1..12}; do echo wait_60; done; printf 'stop\nquit\n'; } >"$out/route.cfg"
    "$root/scripts/record_demo.sh" "$out/route.cfg" "$demo" "$1" || return 1
    "$vkpt" record "$demo" --basedir "$out/base" -o "$2"
}

measure_frame() { # MAP-NAME TRACE FRAME
    local converged=$out/$1.$3.pfm
    [[ -s $converged ]] || "$vkpt" render "$2@$3" --basedir "$out/base" --size $size --spp "${VKPT_MOTION_SPP:-256}" \
        -o "$converged" || return 1
    "$vkpt" render "$2@$(($3 - before))" --basedir "$out/base" --size $size --frames $((before + 1)) \
        ${live[@]+"${live[@]}"} -o "$out/live.pfm" || return 1
    "$vkpt" diff "$converged" "$out/live.pfm" --json | sed -nE 's/.*"(rel_mse|mean_difference|flip|specks)": ([^,]*),?/\1 \2/p' \
        | awk -v row="$1,$3" '{ value[$1] = $2 }
            END { print row "," value["rel_mse"] "," value["mean_difference"] "," value["flip"] "," value["specks"] }' >>"$csv"
}

for map in "$@"; do
    name=$(basename "$map" .bsp)
    trace=$out/$name.rtrace
    cp "$map" "$out/base/baseq2/maps/" || die "cannot read $map"
    [[ -s $trace ]] || record_walk "$map" "$trace" || die "no walk through $name"
    for frame in "${frames[@]}"; do
        measure_frame "$name" "$trace" "$frame" || die "$name: frame $frame was not measured"
    done
done
awk -F, 'NR > 1 { n[$1]++; mse[$1] += $3; mean[$1] += $4; flip[$1] += $5; specks[$1] += $6 }
    END { printf "| map | FLIP | specks %% | relative MSE | mean |\n|---|---|---|---|---|\n"
        for (map in n)
            printf "| %s | %.4f | %.3f | %.4f | %+.3f |\n", map, flip[map] / n[map], 100 * specks[map] / n[map],
                mse[map] / n[map], mean[map] / n[map] }' "$csv"
