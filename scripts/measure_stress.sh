#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Time and error of every light sampler with 32 to 1024 moving emitters: the table in docs/light-sampling.md.
#
#   scripts/measure_stress.sh OUT [NUMBER...]      default: 32 128 512 1024
#
# For each number, the engine records a demo of the game module's command `stress NUMBER 1` in our map and makes a trace of
# it; `vkpt compare` draws one of its frames with all samplers in turns, and measures against a converged reference.
# VKPT_BUILD_DIR   as in ./play;  VKPT_COMPARE   more arguments for vkpt compare;  VKPT_STRESS_FRAME   which frame (25)
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
help_if_asked "$@"
[[ $# -ge 1 ]] || die_usage "the folder for the results is missing"
mkdir -p "$1" || die "cannot write to $1"
out=$(cd "$1" && pwd)
shift
(($#)) || set -- 32 128 512 1024
vkpt=$build_dir/bin/vkpt
read -ra more <<<"${VKPT_COMPARE:-}"

for number in "$@"; do
    [[ $number =~ ^[1-9][0-9]*$ ]] || die_usage "'$number' is no number of emitters"
    trace=$out/stress$number.rtrace
    if [[ ! -s $trace ]]; then
        printf 'stress %s 1\nwait_60\nwait_60\nwait_60\nstop\nquit\n' "$number" >"$out/route.cfg"
        "$root/scripts/record_demo.sh" "$out/route.cfg" "$out/stress$number.dm2" || exit 1
        "$vkpt" record "$out/stress$number.dm2" --timedemo --basedir "$build_dir/game" -o "$trace" || exit 1
    fi
    say "$number emitters:"
    "$vkpt" compare "$trace@${VKPT_STRESS_FRAME:-25}" --samplers all --denoisers off --size 192x108 --runs 4 \
        --reference-spp 512 --reference-sampler subset_pps --basedir "$build_dir/game" \
        ${more[@]+"${more[@]}"} -o "$out/stress$number" || exit 1
done
