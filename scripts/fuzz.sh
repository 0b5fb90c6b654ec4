#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Builds the fuzz harnesses and runs them by turns. See --help and docs/fuzzing.md.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"

print_help() {
    cat <<'HELP'
Usage: scripts/fuzz.sh [OPTION]... [HOURS]

Builds the fuzz harnesses with clang and runs them in turns for HOURS (default 1; fractions too), each from its existing
corpus. At the end it stores what is new, a small corpus in fuzz/corpus and findings in fuzz/findings, and prints how
often each harness ran. The exit status is 0 without a finding, 1 with one.

  --only NAME,...  only these harnesses; the names are those of fuzz/*_fuzzer.cpp and of the picture formats
  --jobs N         this many processes at once (1)
  --keep           continue with the corpus in build/fuzz-work, but leave fuzz/corpus as it is
  -h, --help       this text

Needs the Debian package clang. Everything else is installed by ./test --setup-only.
HELP
}

hours=1 only='' jobs=1 keep_only=no
while (($#)); do
    case $1 in
    -h | --help) print_help; exit 0 ;;
    --only) only=${2:-}; shift ;;
    --jobs) jobs=${2:-}; shift ;;
    --keep) keep_only=yes ;;
    -*) die_usage "unknown option '$1'" ;;
    *) hours=$1 ;;
    esac
    shift
done
[[ $hours =~ ^[0-9]*\.?[0-9]+$ ]] || die_usage "HOURS is a number, not '$hours'"
[[ $jobs =~ ^[1-9][0-9]*$ ]] || die_usage "--jobs needs a number, not '$jobs'"
has clang++ || die "clang++ is not installed: sudo apt install clang"

work=$root/build/fuzz-work
checked=$root/build/fuzz
fast=$root/build/fuzz-fast
seeds=$checked/fuzz/seeds
max_kept=160000 # bytes of fuzz/corpus for each harness

# Share of the time, longest input in bytes, 1: half of the time without sanitizers, which is many times as fast.
limits_of() {
    case $1 in
    bsp) echo "12 16384 1" ;;
    md2 | md3 | iqm) echo "6 8192 1" ;;
    trace) echo "8 8192 1" ;;
    frames) echo "8 4096 1" ;;
    map_source) echo "8 4096 0" ;;
    jpg | png | tga | pcx) echo "4 4096 1" ;;
    wal | m8 | m32) echo "2 4096 1" ;;
    sp2) echo "4 2048 1" ;;
    cvars | paths | options | entities | cameras | materials | game_text) echo "5 512 1" ;;
    *) echo "2 4096 1" ;;
    esac
}

build_harnesses() {
    local preset
    for preset in fuzz fuzz-fast; do
        [[ -e $root/build/$preset/build.ninja ]] \
            || run_step "configure-$preset" "Configuring (cmake --preset $preset)" cmake --preset "$preset" -S "$root" \
            || die "cmake failed"
    done
    run_step fuzz-build "Building the harnesses under both sanitizers" \
        cmake --build "$checked" --target harness_programs fuzz_seeds || die "the build failed"
    run_step fuzz-fast-build "Building the harnesses without them" cmake --build "$fast" --target harness_programs || die "the build failed"
}

# Executions that libFuzzer's log tells of.
count_executions() { sed -nE 's/^stat::number_of_executed_units: *([0-9]+)/\1/p' "$1" | awk '{ sum += $1 } END { print sum + 0 }'; }

# run_harness BUILD NAME SECONDS MAX_LEN: a turn; adds a line to the table. Findings go to the work folder first.
run_harness() {
    local build=$1 name=$2 seconds=$3 max_len=$4 log kind=checked
    [[ $build == "$fast" ]] && kind=fast
    log=$work/log/$name.$kind.$(date +%s%N)
    mkdir -p "$work/corpus/$name" "$work/found/$name" "$work/log"
    local -a dictionary=()
    [[ -e $root/fuzz/dictionaries/$name.dict ]] && dictionary=("-dict=$root/fuzz/dictionaries/$name.dict")
    local -a folders=("$work/corpus/$name")
    local folder
    for folder in "$seeds/$name" "$root/fuzz/corpus/$name" "$root/fuzz/findings/$name"; do
        [[ -d $folder ]] && folders+=("$folder")
    done
    (cd "$work/found/$name" && ASAN_OPTIONS=detect_leaks=0,allocator_may_return_null=0,quarantine_size_mb=16 UBSAN_OPTIONS=print_stacktrace=1 \
        nice -n 19 "$build/fuzz/${name}_fuzzer" "${dictionary[@]}" "-max_len=$max_len" "-max_total_time=$seconds" \
        -timeout=600 -malloc_limit_mb=512 -rss_limit_mb=2048 -print_final_stats=1 -reload=0 -verbosity=1 "${folders[@]}") >"$log" 2>&1 </dev/null
    local status=$?
    printf '%s %s %s %s\n' "$name" "$kind" "$(count_executions "$log")" "$status" >>"$work/table"
    ((status == 0)) || warn "$name: a finding; see ${log#"$root"/}"
}

# The smallest set of inputs that reaches the same, as far as there is room for it in the project.
keep_corpus() {
    local name=$1 merged=$work/merged/$name file size total=0
    rm -rf "$merged" && mkdir -p "$merged" "$root/fuzz/corpus/$name"
    "$checked/fuzz/${name}_fuzzer" -merge=1 -timeout=600 -rss_limit_mb=2048 "$merged" "$root/fuzz/corpus/$name" "$work/corpus/$name" \
        >"$work/log/$name.merge" 2>&1 </dev/null || warn "$name: the corpus could not be merged; see $work/log/$name.merge"
    rm -rf "${root:?}/fuzz/corpus/$name" && mkdir -p "$root/fuzz/corpus/$name"
    while read -r size file; do
        total=$((total + size))
        ((total <= max_kept)) || break
        cp "$file" "$root/fuzz/corpus/$name/"
    done < <(find "$merged" -type f -printf '%s %p\n' | sort -n)
}

keep_findings() {
    local name=$1 file
    for file in "$work/found/$name"/*; do
        [[ -e $file ]] || continue
        mkdir -p "$root/fuzz/findings/$name"
        cp -n "$file" "$root/fuzz/findings/$name/"
    done
}

choose_harnesses() {
    if [[ -n $only ]]; then
        tr ',' '\n' <<<"$only"
    else
        cat "$checked/fuzz/harnesses.txt"
    fi
}

print_table() {
    awk '{ runs[$1] += $3; if ($2 == "checked") checked[$1] += $3; if ($4 != 0) found[$1]++; total += $3; all_checked += ($2 == "checked") * $3 }
        END {
            printf "%-12s %14s %16s %9s\n", "harness", "executions", "with sanitizers", "findings"
            for (name in runs)
                printf "%-12s %14d %16d %9d\n", name, runs[name], checked[name], found[name] | "sort"
            close("sort")
            printf "%-12s %14d %16d\n", "all", total, all_checked
        }' "$work/table"
}

build_harnesses
mapfile -t names < <(choose_harnesses)
for name in "${names[@]}"; do
    [[ -x $checked/fuzz/${name}_fuzzer ]] || die_usage "there is no harness '$name'; there are: $(tr '\n' ' ' <"$checked/fuzz/harnesses.txt")"
done
mkdir -p "$work"
: >"$work/table"
shares=0
for name in "${names[@]}"; do
    read -r share _ <<<"$(limits_of "$name")"
    shares=$((shares + share))
done
say "-- Fuzzing ${#names[@]} harnesses for $hours hours"
for name in "${names[@]}"; do
    read -r share max_len wants_fast <<<"$(limits_of "$name")"
    seconds=$(awk -v hours="$hours" -v share="$share" -v shares="$shares" -v jobs="$jobs" \
        'BEGIN { print int(hours * 3600 * jobs * share / shares) }')
    ((seconds >= 2)) || seconds=2
    while (($(jobs -rp | wc -l) >= jobs)); do wait -n; done
    (
        if ((wants_fast)); then
            run_harness "$fast" "$name" $((seconds / 2)) "$max_len"
            seconds=$((seconds - seconds / 2))
        fi
        run_harness "$checked" "$name" "$seconds" "$max_len"
    ) &
done
wait
for name in "${names[@]}"; do
    keep_findings "$name"
    [[ $keep_only == yes ]] || keep_corpus "$name"
done
print_table
if awk '$4 != 0 { exit 1 }' "$work/table"; then exit 0; fi
say "Findings are in fuzz/findings; build/fuzz/fuzz/NAME_fuzzer FILE shows one again."
exit 1
