#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Runs Yamagi Quake II's dedicated server on our game module, with a home of its own: no display, no renderer.
#
#   scripts/run_server.sh RUN_DIR ENGINE-ARGUMENT...
#
# VKPT_SERVER_PRELOAD   a library to load first, as a sanitizer's.
# Files in RUN_DIR/files are put into the writable game folder first. VKPT_DATA names other game data, VKPT_GAME another
# game directory than vkpt.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
. "$root/scripts/lib/engine.sh"
[[ $# -ge 1 ]] || die "usage: run_server.sh RUN_DIR ENGINE-ARGUMENT..."
run_dir=$1
shift
game_name=${VKPT_GAME:-vkpt}
log_dir=$run_dir
prepare_run_dir home
engine=$(find_engine)
server=${engine%/*}/q2ded
[[ -x $server ]] || die "no dedicated server beside $engine (package yamagi-quake2-core)"
{ cp "$server" "$run_dir/q2ded" && chmod 755 "$run_dir/q2ded"; } || die "cannot copy $server to $run_dir"
[[ ! -d $run_dir/files ]] || as_player cp -r "$run_dir/files/." "$home_dir/.yq2/$game_name/"
data=$(use_data "${VKPT_DATA:-$build_dir/game}") || exit 1
write_settings +set game "$game_name" +set logfile 2 "$@"
cd "$run_dir" || exit 1
export HOME=$home_dir
unset XDG_DATA_HOME XDG_CONFIG_HOME
exec_as_player env LD_PRELOAD="${VKPT_SERVER_PRELOAD:-}" "$run_dir/q2ded" -datadir "$data" "${engine_words[@]}"
