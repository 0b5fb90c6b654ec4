#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What light samplers cost: time of direct and indirect lighting, as ratio to `subset` with a subset of 8. Runs take turns,
# so that a busy machine slows all of them; the table has the median over rounds of each round's ratio.
#   scripts/measure_samplers.sh [ROUNDS]
# SCENE, SIZE and FRAMES change what is measured.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
rounds=${1:-5}
scene=${SCENE:-maps/vkpt1.bsp}
size=${SIZE:-640x360}
frames=${FRAMES:-8}
vkpt=$build_dir/bin/vkpt
[[ -x $vkpt ]] || die "$vkpt is not built"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Milliseconds of direct and indirect light, medians over the frames.
measure() { # SAMPLER SUBSET
    "$vkpt" render "$scene" --basedir "$build_dir/game" --size "$size" --frames "$frames" --seed 1 --verbose \
        --set flt_denoiser=off --set flt_taa=off --set pt_times=1 --set pt_light_sampler="$1" --set pt_light_subset="$2" -o "$folder/frame.png" 2>&1 \
        | awk '/pass (direct|indirect)_light / { sum += $5 } END { print sum }'
}

cases=("subset 8" "subset 16" "subset 32" "subset 64" "subset_onesweep 8" "subset_strides 8" "subset_mis 8"
    "subset_mis_biased 8" "uniform 8" "ris 8" "full 8")
for ((round = 0; round < rounds; round++)); do
    for case in "${cases[@]}"; do
        # shellcheck disable=SC2086
        time=$(measure $case)
        [[ $case == "subset 8" ]] && base=$time
        echo "$case $time $base" >>"$folder/times"
    done
done
echo "| sampler | subset | ratio | ms |"
echo "|---|---|---|---|"
for case in "${cases[@]}"; do
    grep "^$case " "$folder/times" | awk '{ print $3 / $4, $3 }' | sort -g \
        | awk -v name="${case% *}" -v subset="${case#* }" '{ r[NR] = $1; t[NR] = $2 }
            END { m = int((NR + 1) / 2); printf "| `%s` | %s | %.2f | %.0f |\n", name, subset, r[m], t[m] }'
done
