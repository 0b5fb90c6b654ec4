#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Records our demo anew, through the real engine: plays the route of scripts/demo_route.cfg in our map.
#
#   scripts/record_demo.sh [ROUTE.cfg [DEMO.dm2]]      default: scripts/demo_route.cfg, baseq2/demos/vkpt1.dm2
#
# The route is a list of console commands; it starts when the player stands in the map and ends with the recording. The
# engine runs in real time, so two recordings differ in the last digits of the way; what is stored about the demo's frames
# has to be made anew with it: VKPT_UPDATE_STATISTICS=1 ./test -- -R DemoFrames
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
route=${1:-$root/scripts/demo_route.cfg}
demo=${2:-$root/baseq2/demos/vkpt1.dm2}
[[ ${1:-} != -h && ${1:-} != --help ]] || { sed -n '3,9s/^# \?//p' "$0"; exit 0; }
[[ -r $route ]] || die "no route $route"

folder=$(mktemp -d)
chmod 755 "$folder"
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/files"
cp "$route" "$folder/files/route.cfg"
# What has to be true of every route: the recording around it, and a frame rate that makes `wait` 1/60 s. Nobody shoots
# at the camera.
cat >"$folder/files/record.cfg" <<'CFG'
alias wait_5 "wait;wait;wait;wait;wait"
alias wait_30 "wait_5;wait_5;wait_5;wait_5;wait_5;wait_5"
alias wait_60 "wait_30;wait_30"
wait_60
record new
exec route.cfg
CFG
# Small pictures and few rays: the engine has to keep up with the clock.
run_step record-demo "Recording ${demo##*/} (in real time)" "$root/scripts/run_engine.sh" "$folder" 64x36 \
    +set vid_maxfps 60 +set pt_bounces 0 +set pt_light_subset 1 +set deathmatch 0 +set maxclients 1 +map vkpt1 +exec record.cfg \
    || die "the engine did not play the route"
recorded=$folder/home/.yq2/baseq2/demos/new.dm2
[[ -s $recorded ]] || die "the engine recorded nothing; its console: $folder/home/.yq2/baseq2/qconsole.log"
mkdir -p "${demo%/*}"
install -m 644 "$recorded" "$demo" || die "cannot write $demo"
say "$demo: $(stat -c %s "$demo") bytes"
