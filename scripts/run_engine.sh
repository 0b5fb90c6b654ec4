#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Runs the engine headless on our module, as an unprivileged user, for tests and for recording demos.
#
#   scripts/run_engine.sh RUN_DIR WIDTHxHEIGHT ENGINE-ARGUMENT...
#
# RUN_DIR       a folder that every user may enter; the engine's home is RUN_DIR/home, its process id in RUN_DIR/engine.pid.
#               Files below RUN_DIR/files/ are copied into the engine's writable game folder first.
# VKPT_DATA     the game data (default: the build's own)
# VKPT_BUILD_DIR, VKPT_ENGINE   as in ./play;  VKPT_CACHE_DIR   where drivers and module keep what they compiled
# VKPT_GAME     another game directory than baseq2, as our game module's: vkpt
# VKPT_RENDERER another renderer than vkpt
# The exit status is the engine's.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
. "$root/scripts/lib/engine.sh"
if (($# < 2)) || [[ ! $2 =~ ^[0-9]+x[0-9]+$ ]]; then
    die "usage: run_engine.sh RUN_DIR WIDTHxHEIGHT ENGINE-ARGUMENT..."
fi
run_dir=$1
size=$2
shift 2

game_name=${VKPT_GAME:-baseq2}
log_dir=$run_dir
trap stop_children EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
prepare_run_dir home
[[ ! -d $run_dir/files ]] || as_player cp -r "$run_dir/files/." "$home_dir/.yq2/$game_name/"
data=$(use_data "${VKPT_DATA:-$build_dir/game}") || exit 1
[[ $game_name == baseq2 ]] || set -- +set game "$game_name" "$@"
start_xvfb 1280 960
(exec_engine "$data" +set s_openal 0 +set s_sdldriver dummy +set vid_fullscreen 0 +set r_mode -1 \
    +set r_customwidth "${size%x*}" +set r_customheight "${size#*x}" "$@") </dev/null &
engine_pid=$!
echo "$engine_pid" >"$run_dir/engine.pid"
wait "$engine_pid"
status=$?
engine_pid=
exit "$status"
