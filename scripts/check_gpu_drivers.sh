#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Runs whole frames through Mesa's drivers for GPUs that this machine does not have. See --help.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
library_folder=/usr/lib/x86_64-linux-gnu
icd_folder=/usr/share/vulkan/icd.d
budgets=$root/scripts/gpu_budgets.txt

print_help() {
    cat <<'HELP'
Usage: scripts/check_gpu_drivers.sh [OPTION]... [GPU:BACKEND]...

Draws frames of our map and of our demo on GPUs that are not there: Debian's mesa-drm-shim stands in for the kernel, Mesa's own
driver compiles every shader and records every command, and nothing is executed. So pictures and times mean nothing; what counts is
that every call is valid (the validation layer is on), that nothing fails, and what the compiler made of each pass: a table of
registers, spills, code size and waves. What is over its budget in scripts/gpu_budgets.txt fails: a pass, and the device memory that
our map takes at two sizes, measured with query.

  GPU      navi21 navi31 vangogh vega10 raven polaris10 (AMD)
  BACKEND  software, query, pipeline, or auto: what the module takes by itself
  Without any: navi21:software navi21:query, in our map alone, as ./test does.

  --all            navi21, navi31 and vangogh with every backend, vega10 and polaris10 with software; map and demo
  --budgets        print a line of budgets for each pass instead of comparing (what was found, and 2 % more)
  --require        fail where mesa-drm-shim is not installed, instead of skipping
  --basedir DIR    the folder that contains baseq2/ (default: the build's game data)
  -h, --help       this text

  VKPT_BUILD_DIR=DIR   another build than build/release

Exit status: 0 all is well, 1 something is not, 2 wrong use, 77 mesa-drm-shim or Mesa's AMD driver is not installed.
HELP
}

runs=() all=no prints_budgets=no required=no base_folder=$build_dir/game
while (($#)); do
    case $1 in
    -h | --help) print_help; exit 0 ;;
    --all) all=yes ;;
    --budgets) prints_budgets=yes ;;
    --require) required=yes ;;
    --basedir) shift; base_folder=${1:?--basedir needs a folder} ;;
    -*) die_usage "unknown option '$1'" ;;
    *:software | *:query | *:pipeline | *:auto) runs+=("$1") ;;
    *) die_usage "'$1' is not GPU:BACKEND" ;;
    esac
    shift
done
if [[ $all == yes ]]; then
    runs+=(navi21:{software,query,pipeline,auto} {navi31,vangogh}:{software,query,pipeline} {vega10,polaris10}:software)
elif ((${#runs[@]} == 0)); then
    runs=(navi21:software navi21:query)
fi

shim=$library_folder/libamdgpu_noop_drm_shim.so
icd=
for file in "$icd_folder"/radeon_icd*.json; do [[ -e $file ]] && icd=$file; done
if [[ ! -e $shim || -z $icd ]]; then
    [[ $required == no ]] || die "mesa-drm-shim and mesa-vulkan-drivers are not both installed"
    say "not checked: mesa-drm-shim and mesa-vulkan-drivers are not both installed"
    exit 77
fi
vkpt=$build_dir/bin/vkpt
[[ -x $vkpt ]] || die "$vkpt is not built"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
scenes=(maps/vkpt1.bsp)
if [[ $all == yes ]]; then
    "$vkpt" record vkpt1.dm2 --basedir "$base_folder" --timedemo -o "$folder/demo.rtrace" >"$folder/record.log" 2>&1 \
        || die "our demo could not be recorded: $(tail -n 3 "$folder/record.log")"
    scenes+=("$folder/demo.rtrace@40")
fi
failures=0
fail() {
    printf 'FAILED: %s\n' "$*"
    failures=$((failures + 1))
}

# run_on GPU COMMAND...: with the shim's GPU, the output into $folder/console.
run_on() {
    local gpu=$1
    shift
    rm -rf "$folder/cache"
    mkdir "$folder/cache"
    env LD_PRELOAD="$shim" AMDGPU_GPU_ID="$gpu" VK_ICD_FILENAMES="$icd" VK_DRIVER_FILES="$icd" XDG_CACHE_HOME="$folder/cache" \
        VKPT_CACHE_DIR="$folder/cache" MESA_SHADER_CACHE_DISABLE=1 "$@" >"$folder/console" 2>&1
}

# draw GPU BACKEND SCENE: frames; statistics into $folder/statistics.
draw() {
    rm -f "$folder/statistics"
    run_on "$1" env VKPT_PIPELINE_STATISTICS="$folder/statistics" \
        "$vkpt" render "$3" --basedir "$base_folder" --size 128x96 --frames 4 --verbose -o "$folder/picture.png" \
        --set pt_trace="$2" --set pt_validation=1 --set flt_denoiser=asvgf --set flt_taa=upscale
}

# check_memory GPU: what our map takes of the device's memory with the default settings, at the sizes where there is a budget for it.
check_memory() {
    local size most taken
    while read -r size most; do
        run_on "$1" "$vkpt" bench maps/vkpt1.bsp --basedir "$base_folder" --size "$size" --frames 2 --warmup 0 --set pt_trace=query
        taken=$(sed -nE 's/^memory +([0-9]+) MiB of the device.*/\1/p' "$folder/console")
        [[ -n $taken ]] || { fail "$1: memory was not measured: $(tail -n 4 "$folder/console")"; continue; }
        say "$1: $taken MiB of the device at $size"
        ((taken <= most)) || fail "$1: $taken MiB of the device at $size, budget $most"
    done < <(awk -v gpu="$1" '$1 == gpu && $2 == "memory" { print $3, $4 }' "$budgets")
}

# A line a pass from the driver's figures: PASS VGPRS SGPRS SPILLED CODE SCRATCH WAVES. Of the parts of a ray pipeline the most
# registers, the fewest waves, and the sum of the rest.
summarise() {
    awk -F'\t' '
        function most(a, b) { return a > b ? a : b }
        { shader = $1; seen[shader] = 1 }
        $3 == "VGPRs" { vgprs[shader] = most(vgprs[shader], $4 + 0) }
        $3 == "SGPRs" { sgprs[shader] = most(sgprs[shader], $4 + 0) }
        $3 == "Spilled VGPRs" || $3 == "Spilled SGPRs" { spilled[shader] += $4 }
        $3 == "Code size" { code[shader] += $4 }
        $3 == "Scratch size" { scratch[shader] = most(scratch[shader], $4 + 0) }
        $3 == "Subgroups per SIMD" { if (!(shader in waves) || $4 + 0 < waves[shader]) waves[shader] = $4 + 0 }
        END { for (s in seen) print s, vgprs[s] + 0, sgprs[s] + 0, spilled[s] + 0, code[s] + 0, scratch[s] + 0, waves[s] + 0 }' \
        "$folder/statistics" | sort
}

# compare GPU: the lines of summarise on stdin against the budgets; prints the table.
compare() {
    awk -v gpu="$1" -v budgets="$budgets" '
        BEGIN {
            while ((getline line < budgets) > 0) {
                if (line ~ /^#/ || split(line, word, " ") < 6 || word[1] != gpu) continue
                known[word[2]] = 1; vgprs[word[2]] = word[3]; spilled[word[2]] = word[4]; code[word[2]] = word[5]; scratch[word[2]] = word[6]
            }
            printf "   %-42s %5s %5s %7s %8s %7s %5s\n", "", "VGPRs", "SGPRs", "spilled", "code", "scratch", "waves"
        }
        function check(what, found, budget) {
            if (found > budget) { printf "FAILED: %s on %s: %s %d, budget %d\n", $1, gpu, what, found, budget; over++ }
        }
        {
            printf "   %-42s %5d %5d %7d %8d %7d %5d\n", $1, $2, $3, $4, $5, $6, $7
            if (!($1 in known)) { printf "FAILED: %s on %s has no budget in scripts/gpu_budgets.txt\n", $1, gpu; over++; next }
            check("VGPRs", $2, vgprs[$1]); check("spilled registers", $4, spilled[$1])
            check("bytes of code", $5, code[$1]); check("bytes of scratch", $6, scratch[$1])
        }
        END { exit over > 0 }'
}

print_budgets() {
    awk -v gpu="$1" '{ print gpu, $1, $2, $4, int($5 * 1.02 / 64 + 1) * 64, $6 }'
}

for run in "${runs[@]}"; do
    gpu=${run%%:*} backend=${run##*:}
    : >"$folder/summary"
    for scene in "${scenes[@]}"; do
        draw "$gpu" "$backend" "$scene"
        status=$?
        ((status == 0)) || fail "$run, ${scene##*/}: vkpt ended with $status: $(tail -n 4 "$folder/console")"
        if grep -q "vkpt validation:" "$folder/console"; then
            fail "$run, ${scene##*/}: $(grep -c "vkpt validation:" "$folder/console") validation messages: $(grep -m1 "vkpt validation:" "$folder/console")"
        fi
        grep -q "a second queue for compute" "$folder/console" || fail "$run: the second queue was not taken"
        [[ $backend == auto ]] || grep -q "rays by $backend" "$folder/console" || fail "$run, ${scene##*/}: rays are not traced by $backend"
        [[ $backend != auto ]] || grep -q "measures no times" "$folder/console" || fail "$run: a device that does nothing was measured"
        [[ -s $folder/statistics ]] && summarise >>"$folder/summary" || fail "$run, ${scene##*/}: the driver told nothing of its pipelines"
    done
    sort -u "$folder/summary" >"$folder/passes"
    if [[ $prints_budgets == yes ]]; then
        print_budgets "$gpu" <"$folder/passes"
        continue
    fi
    say "$run: $(grep -m1 -o 'ref_vkpt: .*RADV[^)]*)' "$folder/console" | sed 's/ref_vkpt: //')"
    compare "$gpu" <"$folder/passes" || failures=$((failures + 1))
    [[ $backend != query ]] || check_memory "$gpu"
done
((failures == 0))
