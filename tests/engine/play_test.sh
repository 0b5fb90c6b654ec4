#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# ./play without a display: pictures, a contact sheet and where ffmpeg is there a film, quickly a second time; its first start in a
# window; and clear words for wrong use.
#   play_test.sh BUILD_DIR
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
export VKPT_BUILD_DIR=$1 CI=true
folder=$(mktemp -d)
chmod 755 "$folder"
trap 'rm -rf "$folder"' EXIT
export VKPT_RUN_DIR=$folder/run VKPT_CACHE_DIR=$1/tests/engine/cache VKPT_PICTURES=6
unset DISPLAY WAYLAND_DISPLAY
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}
# expect STATUS PATTERN COMMAND...: the command ends with STATUS and says PATTERN.
expect() {
    local status=$1 pattern=$2 output got=0
    shift 2
    output=$("$@" 2>&1 </dev/null) || got=$?
    [[ $got -eq $status ]] || fail "$* ended with $got instead of $status: $output"
    grep -qE -- "$pattern" <<<"$output" || fail "$* did not say '$pattern': $output"
}

play() { "$root/play" --no-setup "$@"; }

# Where only ./play has been started, nothing else is built: all that the scripts run is among what its target makes.
made=$(ninja -C "$1" -t commands play) || fail "no target 'play' in $1"
while read -r program; do
    grep -qF -- "-o $program " <<<"$made" || fail "the target 'play' does not make $program"
done < <(grep -ohE 'build_dir/(bin|scripts)/[a-z_.]+' "$root"/scripts/lib/*.sh | sed 's|^build_dir/||' | sort -u)

expect 0 'contact_sheet.png' play --size 96x54 --out "$folder/out"
pictures=$(find "$folder/out" -name 'frame*.png' | wc -l)
((pictures >= 5 && pictures <= 13)) || fail "$pictures pictures instead of about 6"
[[ -s $folder/out/contact_sheet.png ]] || fail "no contact sheet"
if command -v ffmpeg >/dev/null; then
    [[ -s $folder/out/demo.mp4 ]] || fail "no film"
fi
expect 0 'Engine: +[0-9]+ frames, .* fps' play --size 96x54 --timedemo
expect 0 'Pass: +' play --size 96x54 --timedemo --set pt_bounces=0 --set pt_bench_json=bench
# The keys that `vkpt bench --json` has, too.
perl -MJSON::PP -e 'local $/; my $b = decode_json(<STDIN>); exit !($b->{schema} == 1 && $b->{scene} eq "maps/vkpt1.bsp"
    && $b->{frame_ms}{median} > 0 && @{$b->{passes}} > 3 && @{$b->{cpu}} > 3 && $b->{settings}{pt_bounces} eq "0"
    && $b->{start}{first_frame_s} > 0)' <"$folder/run/home/.yq2/baseq2/vkpt/bench/bench.json" || fail "bench.json is not what it should be"
# In a window: where no GPU traces rays, the first start asks for 30 frames a second, and the engine keeps what it was told.
# shellcheck disable=SC2119,SC2120  # of the function
in_window() { xvfb-run -a -s '-screen 0 320x240x24' "$root/play" --no-setup --size 96x54 "$@" -- +set s_initsound 0 +quit; }
config=$folder/run/home/.yq2/vkpt/config.cfg
if bash -c 'root=$0; . "$root/scripts/lib/common.sh"; . "$root/scripts/lib/play.sh"; has_raytracing_gpu' "$root"; then
    echo "a GPU traces rays here: the first start without one is not tried"
else
    expect 0 '30 frames a second' in_window
    grep -qE '^set pt_target_ms "33' "$config" || fail "the first start did not keep its time of a frame"
    output=$(in_window 2>&1 </dev/null) || fail "the second start ended with $?: $output"
    grep -F '30 frames a second' <<<"$output" && fail "the second start was taken for the first"
    rm -f "$config"
    expect 0 '30 frames a second' in_window --set pt_target_ms=0
    grep -qE '^set pt_target_ms "0' "$config" || fail "the first start did not take the caller's time of a frame"
fi

expect 1 'no demo .nothere' play --timedemo nothere
expect 2 'gpu-report is about our own demo' play --gpu-report --timedemo
expect 1 'no map .nothere' play --headless --map nothere
expect 1 'no Quake II data in' play --data "$folder"
expect 1 'no-such-gpu' play --size 96x54 --timedemo --set pt_device=no-such-gpu
expect 2 'WIDTHxHEIGHT' play --size wide
expect 2 'NAME=VALUE' play --set pt_bounces
expect 2 'unknown option' play --nonsense
expect 0 'Usage' play --help
pgrep -f "$VKPT_RUN_DIR" >/dev/null && fail "something was left running: $(pgrep -af "$VKPT_RUN_DIR")"
((failures == 0))
