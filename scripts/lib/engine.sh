# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # root, build_dir: see common.sh
# Running Yamagi Quake II on our module: a private run directory, an unprivileged user, a display where there is none.
#
# The engine opens ref_NAME.so in the directory of its own executable (after symbolic links), so the run directory holds
# a copy of the engine and links to everything else. The installed engine is never touched.

own_game=vkpt # the game directory of our game module
run_dir=${VKPT_RUN_DIR:-$root/build/run}
shared_cache_dir=${VKPT_CACHE_DIR:-$run_dir/cache} # for every run, whichever its run directory
xvfb_pid=
engine_pid=

find_engine() {
    local path
    for path in "${VKPT_ENGINE:-}" /usr/lib/yamagi-quake2/quake2 /usr/lib/games/quake2/quake2 /usr/games/yquake2 /usr/lib/yquake2/quake2; do
        [[ -n $path && -x $path ]] && readlink -f "$path" && return 0
    done
    path=$(dpkg -L yamagi-quake2 2>/dev/null | grep -E '/y?quake2$' | while read -r file; do [[ -f $file && -x $file ]] && echo "$file"; done | head -n 1)
    [[ -n $path ]] && readlink -f "$path"
}

# --- the player: the engine refuses to run as root ----------------------------------------------------------------

# Sets player_uid and player_gid: the owner of the checkout, whoever called sudo, or nobody.
choose_player() {
    player_uid=$(id -u)
    player_gid=$(id -g)
    is_root || return 0
    player_uid=$(stat -c %u "$root")
    player_gid=$(stat -c %g "$root")
    if ((player_uid == 0)) && [[ ${SUDO_UID:-0} -ne 0 ]]; then
        player_uid=$SUDO_UID
        player_gid=${SUDO_GID:-$SUDO_UID}
    fi
    if ((player_uid == 0)); then
        player_uid=$(id -u nobody 2>/dev/null || echo 65534)
        player_gid=$(id -g nobody 2>/dev/null || echo 65534)
    fi
}

# With sudo, or as root in somebody's checkout: all that follows the set-up is done as the checkout's owner, so that what
# is built belongs to them. Starts the calling script anew; returns where nothing is to be changed.
continue_as_owner() {
    local owner group groups=--clear-groups home
    is_root || return 0
    owner=$(stat -c %u "$root")
    group=$(stat -c %g "$root")
    ((owner != 0)) || return 0
    if [[ -e $build_dir && $(stat -c %u "$build_dir") -ne $owner ]]; then return 0; fi
    mkdir -p "$log_dir" && chown "$owner:$group" "$root/build" && chown -hR "$owner:$group" "$log_dir"
    home=$(getent passwd "$owner" | cut -d: -f6)
    [[ -n $home ]] && groups=--init-groups
    [[ -n $home && -d $home ]] || home=$root/build
    exec setpriv --reuid "$owner" --regid "$group" "$groups" -- env HOME="$home" "$root/${0##*/}" --no-setup "$@"
}

# The groups that own the GPU's device files: an unprivileged user needs them, or sees the CPU driver only.
gpu_groups() {
    stat -c %g /dev/dri/renderD* /dev/dri/card* /dev/nvidia* 2>/dev/null | grep -vx 0 | sort -un | paste -sd, -
}

# as_player COMMAND...: replaces the calling (sub)shell.
exec_as_player() {
    if ! is_root; then
        exec "$@"
    fi
    local groups
    groups=$(gpu_groups)
    if [[ -n $groups ]]; then
        exec setpriv --reuid "$player_uid" --regid "$player_gid" --groups "$groups" -- "$@"
    fi
    exec setpriv --reuid "$player_uid" --regid "$player_gid" --clear-groups -- "$@"
}
as_player() { (exec_as_player "$@"); }

# --- the run directory --------------------------------------------------------------------------------------------

# Prints a folder of ours that every user can enter.
make_outside_dir() {
    local dir
    dir=/var/tmp/ref_vkpt-run-$(id -u)
    if [[ ! -e $dir ]]; then
        mkdir -m 755 "$dir" || die "cannot make $dir"
    fi
    [[ -d $dir && ! -L $dir && -O $dir ]] || die "$dir exists, but does not belong to this user; move it away"
    echo "$dir"
}

# Where the player cannot come (a checkout below /root), files are copied to a place where they can.
choose_run_dir() {
    mkdir -p "$run_dir" || die "cannot write to $run_dir"
    as_player test -x "$run_dir" -a -r "$run_dir" && return 0
    run_dir=$(make_outside_dir) || exit 1
    note "user $player_uid cannot read $root: module and data are copied to $run_dir"
}

# provide SOURCE DESTINATION: a link, or where the player cannot follow it, a fresh copy.
provide() {
    local source=$1 destination=$2
    if as_player test -r "$source"; then
        [[ $(readlink "$destination") == "$source" ]] && return 0
        rm -rf "$destination"
        ln -s "$source" "$destination"
        return
    fi
    if [[ -L $destination ]]; then rm -f "$destination"; fi
    if [[ -d $source ]]; then
        mkdir -p "$destination"
        cp -Lru "$source/." "$destination/" && chmod -R a+rX "$destination"
    else
        cmp -s "$source" "$destination" || { cp -L "$source" "$destination.new" && chmod a+rx "$destination.new" && mv "$destination.new" "$destination"; }
    fi
}

# link_game NAME: our game module, or the engine's own files of a game (game.so and small fixes of maps) beside the engine's copy. A mod
# without a game.so for this engine gets the stock one. The engine's yq2.cfg comes with the user's data only: it binds all
# keys anew, after our default.cfg.
link_game() {
    local name=$1 engine_dir=$2 file target
    if [[ $name == "$own_game" ]]; then
        provide "$build_dir/game/$own_game" "$run_dir/$own_game"
        return
    fi
    mkdir -p "$run_dir/$name"
    for file in "$engine_dir/$name"/*; do
        [[ -e $file ]] || continue
        target=$run_dir/$name/${file##*/}
        if [[ ${file##*/} == yq2.cfg && ${find_data:-no} == no ]]; then
            rm -f "$target"
            continue
        fi
        [[ $(readlink "$target") == "$file" ]] || ln -sfn "$file" "$target"
    done
    if [[ ! -e $run_dir/$name/game.so && ! -e ${data_dir:-}/$name/game.so ]]; then
        note "this engine has no game.so for '$name': using the stock game with its files"
        ln -sfn "$engine_dir/baseq2/game.so" "$run_dir/$name/game.so"
    fi
}

# A folder that we made for the player carries this mark. As root only such ones change hands: a path from the environment may
# name any folder of the system.
own_mark=.made-by-ref_vkpt

# give_folder DIR: makes DIR, or takes it if we made it, and hands it to the player. True if the player may write there.
give_folder() {
    local dir=$1
    if [[ ! -e $dir && ! -L $dir ]]; then
        mkdir -p "$dir" 2>/dev/null && : >"$dir/$own_mark" || return 1
    fi
    if [[ ! -L $dir && -f $dir/$own_mark && ! -L $dir/$own_mark ]]; then
        chmod go-w "$dir" # the module takes nothing from a folder that others may write to
        if is_root; then chown -hR "$player_uid:$player_gid" "$dir"; fi
    fi
    as_player test -d "$dir" -a -w "$dir"
}

# What driver and module compile goes to a folder that the player may write.
choose_cache_dir() {
    local outside
    cache_dir=$shared_cache_dir
    give_folder "$cache_dir" && return 0
    outside=$(make_outside_dir) || exit 1
    cache_dir=$outside/cache
    give_folder "$cache_dir" && return 0
    die "user $player_uid cannot write to $shared_cache_dir; set VKPT_CACHE_DIR to use another folder"
}

# prepare_run_dir HOME_NAME: sets home_dir, cache_dir and engine_binary.
prepare_run_dir() {
    local engine engine_dir file
    engine=$(find_engine) || die "Yamagi Quake II is not installed (package yamagi-quake2); set VKPT_ENGINE to its path if it is elsewhere"
    engine_dir=${engine%/*}
    choose_player
    choose_run_dir
    engine_binary=$run_dir/quake2
    cmp -s "$engine" "$engine_binary" || { rm -f "$engine_binary" && cp "$engine" "$engine_binary" && chmod 755 "$engine_binary"; } \
        || die "cannot copy $engine to $run_dir"
    for file in "$engine_dir"/ref_*.so; do
        [[ -e $file ]] && ln -sfn "$file" "$run_dir/${file##*/}"
    done
    [[ -e $build_dir/bin/ref_vkpt.so ]] \
        || die "$build_dir/bin/ref_vkpt.so is missing; build first: cmake --build --preset release"
    provide "$build_dir/bin/ref_vkpt.so" "$run_dir/ref_vkpt.so"
    # The video menu lists the renderers that the engine knows by name. Ours is none of them; vk is one that most engines lack.
    [[ -e $engine_dir/ref_vk.so ]] || provide "$build_dir/bin/ref_vkpt.so" "$run_dir/ref_vk.so"
    link_game baseq2 "$engine_dir"
    [[ ! -e $build_dir/game/$own_game/game.so ]] || link_game "$own_game" "$engine_dir"
    [[ ${game_name:-baseq2} =~ ^(baseq2|$own_game)$ ]] || link_game "$game_name" "$engine_dir"
    home_dir=$run_dir/$1
    give_folder "$home_dir" || die "$home_dir belongs to another user (perhaps from an earlier run); remove it: sudo rm -r $home_dir"
    as_player mkdir -p "$home_dir/.yq2/${game_name:-baseq2}" "$home_dir/.local/share"
    choose_cache_dir
}

# use_data DIR: DIR with a baseq2 in it, as the player can read it; prints the folder to give to the engine.
use_data() {
    if as_player test -r "$1/baseq2" -a -x "$1/baseq2"; then
        echo "$1"
        return
    fi
    provide "$1" "$run_dir/data" || die "user $player_uid cannot read $1, and it could not be copied to $run_dir/data"
    echo "$run_dir/data"
}

# --- the display --------------------------------------------------------------------------------------------------

has_display() { [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]]; }

# start_xvfb WIDTH HEIGHT: on a free display; exports DISPLAY. Keys do not repeat (-r): those that scripts press may be down for
# long where the machine is slow.
start_xvfb() {
    local number_file=$home_dir/display
    has Xvfb || die "Xvfb is not installed (package xvfb)"
    rm -f "$number_file"
    as_player touch "$number_file"
    ( exec_as_player env HOME="$home_dir" Xvfb -displayfd 3 -screen 0 "$1x$2x24" -nolisten tcp -noreset -r 3>"$number_file" ) \
        </dev/null >"$log_dir/xvfb.log" 2>&1 &
    xvfb_pid=$!
    while [[ ! -s $number_file ]] && kill -0 "$xvfb_pid" 2>/dev/null; do sleep 0.05; done
    [[ -s $number_file ]] || { tail -n 5 "$log_dir/xvfb.log" >&2; die "Xvfb did not start"; }
    DISPLAY=:$(<"$number_file")
    export DISPLAY SDL_VIDEODRIVER=x11
    unset WAYLAND_DISPLAY XAUTHORITY
}

# The player needs the caller's X cookie where the player is somebody else.
share_display() {
    local cookie=${XAUTHORITY:-$HOME/.Xauthority}
    is_root && [[ -r $cookie ]] || return 0
    cp "$cookie" "$home_dir/.Xauthority" && chown "$player_uid:$player_gid" "$home_dir/.Xauthority" && chmod 600 "$home_dir/.Xauthority"
    export XAUTHORITY=$home_dir/.Xauthority
}

stop_children() {
    local pid
    for pid in $engine_pid $xvfb_pid; do
        kill "$pid" 2>/dev/null && wait "$pid" 2>/dev/null
    done
    engine_pid=
    xvfb_pid=
}

# --- the engine ---------------------------------------------------------------------------------------------------

console_log() { echo "$home_dir/.yq2/${game_name:-baseq2}/qconsole.log"; }

# write_settings ARGUMENTS...: moves "+set NAME VALUE" into autoexec.cfg, which the engine reads before it starts the renderer:
# it takes no more than 50 words on its command line. What is left is in $engine_words.
write_settings() {
    local game=baseq2 lines=""
    engine_words=()
    while (($#)); do
        if [[ $1 == +set && $# -ge 3 ]]; then
            case $2 in
            game) game=$3 ;&
            # The game module looks for the library on the command line.
            vid_renderer | logfile | vkpt_game_library) engine_words+=("$1" "$2" "$3") ;;
            *) lines+="set $2 \"$3\""$'\n' ;;
            esac
            shift 3
        else
            engine_words+=("$1")
            shift
        fi
    done
    local folder=$home_dir/.yq2/$game
    as_player mkdir -p "$folder"
    printf '%s' "$lines" | as_player tee "$folder/autoexec.cfg" >/dev/null
}

# exec_engine DATA ARGUMENTS...: replaces the calling (sub)shell by the engine.
exec_engine() {
    local data=$1
    shift
    write_settings +set vid_renderer "${VKPT_RENDERER:-vkpt}" +set logfile 2 +set allow_download 0 "$@"
    cd "$run_dir" || exit 1
    export HOME=$home_dir XDG_CACHE_HOME=$cache_dir VKPT_CACHE_DIR=$cache_dir
    unset XDG_DATA_HOME XDG_CONFIG_HOME
    exec_as_player "$engine_binary" -datadir "$data" "${engine_words[@]}"
}

# Why the engine did not keep our module, from its console; nothing where it did.
fallback_reason() {
    grep -q '^Retrying with' "$(console_log)" 2>/dev/null || return 1
    sed -n '/Loading library: ref_vk/,/^Retrying with/p' "$(console_log)" | sed -e '/^Loading library/d' -e '/^Retrying with/d' -e '/^-*$/d'
}
