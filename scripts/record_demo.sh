#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Records our demo anew, through the real engine: plays the route of scripts/demo_route.cfg in our map.
#
#   scripts/record_demo.sh [ROUTE.cfg [DEMO.dm2 [MAP.bsp]]]      default: scripts/demo_route.cfg, baseq2/demos/vkpt1.dm2
#
# MAP.bsp: a map file to play in instead of ours.
# The route is a list of console commands; it starts when the player stands in the map and ends with the recording. What is
# stored about the demo's frames has to be made anew with it: VKPT_UPDATE_STATISTICS=1 ./test -- -R DemoFrames
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
route=${1:-$root/scripts/demo_route.cfg}
demo=${2:-$root/baseq2/demos/vkpt1.dm2}
map=${3:-}
help_if_asked "$@"
[[ -r $route ]] || die "no route $route"
[[ -z $map || -r $map ]] || die "no map $map"

folder=$(mktemp -d)
chmod 755 "$folder"
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/files/maps"
[[ -z $map ]] || cp "$map" "$folder/files/maps/" || die "cannot copy $map"
map_name=$(basename "${map:-vkpt1}" .bsp)
cp "$route" "$folder/files/route.cfg"
# Routes may use our game module's commands. Without a game directory of its own, the demo plays wherever our data is.
cp "$build_dir/game/vkpt/game.so" "$folder/files/game.so" || die "no game module; build first: cmake --build --preset release"
# The recording around the route. `wait` lasts one frame, and at least 16 ms of the clock; a frame is 1/60 s of the game's
# time whatever the clock says. With frames that take longer than 16 ms (hence the CPU driver and the number of bounces)
# both are the same, and the way does not depend on the machine.
cat >"$folder/files/record.cfg" <<'CFG'
alias wait_5 "wait;wait;wait;wait;wait"
alias wait_20 "wait_5;wait_5;wait_5;wait_5"
alias wait_30 "wait_20;wait_5;wait_5"
alias wait_60 "wait_30;wait_30"
notarget
wait_60
record new
wait_30
exec route.cfg
CFG
cpu_driver=$(find /usr/share/vulkan/icd.d -name 'lvp_icd*.json' 2>/dev/null | head -n 1)
export VK_ICD_FILENAMES=${cpu_driver:-${VK_ICD_FILENAMES:-}}
run_step record-demo "Recording ${demo##*/}" "$root/scripts/run_engine.sh" "$folder" 320x180 \
    +set fixedtime 16667 +set pt_bounces 2 +set deathmatch 0 +set maxclients 1 +map "$map_name" +exec record.cfg \
    || die "the engine did not play the route"
recorded=$folder/home/.yq2/baseq2/demos/new.dm2
[[ -s $recorded ]] || die "the engine recorded nothing; its console: $folder/home/.yq2/baseq2/qconsole.log"
mkdir -p "${demo%/*}"
install -m 644 "$recorded" "$demo" || die "cannot write $demo"
say "$demo: $(stat -c %s "$demo") bytes"
