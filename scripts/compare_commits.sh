#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What a frame and its passes take now, compared with an earlier commit: medians of both in turns, and of their ratios.
#
#   scripts/compare_commits.sh COMMIT [SCENE]...      default: maps/vkpt1.bsp maps/bare.bsp
#
# Builds COMMIT in a worktree in build/commits, which stays for the next time, and measures its `vkpt bench` and that of the
# present build in turns: every setting at its default, the present game data for both, and no options that are new. SCENE is a
# map as `vkpt bench` takes it, seen from the player's start if it names no place; maps/bare.bsp is the map of docs/gallery.md
# without liquids and glass. With 8a7994bf~1, the last commit before liquids, glass and fog, the ratios say what effects cost
# where none is in view. A pass without a ratio is in one of the two only.
# VKPT_BUILD_DIR       as in ./play
# VKPT_COMMIT_ROUNDS   turns (5);  VKPT_COMMIT_FRAMES  frames of each (24);  VKPT_COMMIT_SIZE  their size (640x360)
set -euo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
cd "$root"
. scripts/lib/measure.sh
(($#)) || die_usage "the commit to compare with is missing"
commit=$(git rev-parse --verify --quiet --short=12 "$1^{commit}") || die_usage "'$1' is no commit"
shift
(($#)) || set -- maps/vkpt1.bsp maps/bare.bsp
rounds=${VKPT_COMMIT_ROUNDS:-5} frames=${VKPT_COMMIT_FRAMES:-24} size=${VKPT_COMMIT_SIZE:-640x360}
old=$root/build/commits/$commit

build_commit() {
    [[ -e $old/.git ]] || run_step worktree "Checking out $commit" git worktree add --detach --force "$old" "$commit"
    [[ -e $old/build/release/build.ninja ]] \
        || run_step configure-commit "Configuring $commit" \
            cmake --preset release -D BUILD_TESTING=OFF -S "$old" -B "$old/build/release"
    run_step build-commit "Building $commit (the first time takes minutes)" \
        cmake --build "$old/build/release" --parallel "$(nproc)" --target vkpt ref_vkpt
}

# measure WHO ROUND SCENE: a line "WHO <tab> ROUND <tab> row <tab> ms" for the frame and each pass of `vkpt bench`'s table.
measure() {
    "${bin[$1]}/vkpt" bench "$3" --module "${bin[$1]}/ref_vkpt.so" --basedir "$work" --size "$size" --frames "$frames" \
        | awk -v who="$1" -v turn="$2" '$1 == "ms" { in_table = 1; next }
            NF == 0 { in_table = 0 }
            in_table { name = $1; for (i = 2; i < NF && $i !~ /^[0-9.]+$/; i++) name = name " " $i; print who "\t" turn "\t" name "\t" $i }'
}

compare() {
    local scene=$1 round who
    : >"$work/times"
    for ((round = 0; round < rounds; round++)); do
        for who in $( ((round % 2)) && echo now before || echo before now); do
            measure "$who" "$round" "$scene" >>"$work/times" || die "$scene was not measured with $who"
        done
    done
    printf '\n%s\n\n' "$scene, $size, $rounds rounds of $frames frames:"
    awk -F '\t' -v commit="$commit" "$awk_median"'
        function cell(who, name) { return n[who, name] ? sprintf("%.2f", median(ms[who, name], n[who, name])) : "-" }
        { if (!seen[$3]++) order[++names] = $3
          ms[$1, $3] = ms[$1, $3] " " $4; n[$1, $3]++; at[$1, $2, $3] = $4
          if (($2, $3) in met && at["before", $2, $3] > 0) {
              ratios[$3] = ratios[$3] " " at["now", $2, $3] / at["before", $2, $3]; n_ratios[$3]++ }
          met[$2, $3] = 1 }
        END { print "| ms | " commit " | now | ratio |\n|---|---|---|---|"
            for (i = 1; i <= names; i++) { k = order[i]
                printf "| %s | %s | %s | %s |\n", k, cell("before", k), cell("now", k),
                    n_ratios[k] ? sprintf("x%.3f", median(ratios[k], n_ratios[k])) : "" } }' \
        "$work/times"
}

build_commit || die "$commit was not built"
[[ -x $build/bin/vkpt && -f $build/bin/ref_vkpt.so ]] || die "$build/bin has no vkpt and ref_vkpt.so; build first: cmake --build --preset release"
declare -A bin=([before]=$old/build/release/bin [now]=$build/bin)
make_gallery_data "$work" >/dev/null
make_bare_map "$work" >/dev/null
for scene in "$@"; do compare "$scene"; done
