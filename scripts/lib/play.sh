# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # the variables that ./play sets from its options
# What ./play does once everything is built: find data, start the engine, wait for it, show what came of it.

own_map=vkpt1
own_demo=vkpt1.dm2
capture_folder=play # among the captures of vkpt's module

# --- data ---------------------------------------------------------------------------------------------------------

# The home of whoever sits at the machine, with sudo as well.
user_home() {
    local home=
    [[ -n ${SUDO_USER:-} ]] && home=$(getent passwd "$SUDO_USER" | cut -d: -f6)
    echo "${home:-${HOME:-/}}"
}

list_usual_places() {
    local home
    home=$(user_home)
    printf '%s\n' "$home/.yq2" "$home/.local/share/YamagiQ2" /usr/share/games/quake2 /usr/local/share/games/quake2 \
        "$home/.steam/steam/steamapps/common/Quake 2" "$home/.steam/root/steamapps/common/Quake 2" \
        "$home/.local/share/Steam/steamapps/common/Quake 2" \
        "$home/.var/app/com.valvesoftware.Steam/.local/share/Steam/steamapps/common/Quake 2" \
        "$home/GOG Games/Quake II" "$home/GOG Games/Quake II/game" "$home/GOG Games/Quake II Quad Damage" \
        "$home/Games/quake2" "$home/games/quake2" "$home/quake2" /opt/quake2
}

# True where DIR/GAME holds game data: an archive, or loose maps.
holds_data() {
    local file
    for file in "$1/$2"/*.pak "$1/$2"/*.pk3 "$1/$2"/*.pkz "$1/$2"/*.pk2 "$1/$2"/maps/*.bsp; do
        [[ -e $file ]] && return 0
    done
    return 1
}

# Prints the folder that has baseq2 in it, for DIR, DIR's parent (DIR is baseq2 itself), or fails.
normalise_data_dir() {
    local dir
    dir=$(readlink -f -- "$1") || return 1
    holds_data "$dir" baseq2 && echo "$dir" && return 0
    [[ ${dir##*/} == baseq2 ]] && holds_data "${dir%/*}" baseq2 && echo "${dir%/*}"
}

choose_data() {
    local place
    if [[ -n $data_dir ]]; then
        normalise_data_dir "$data_dir" && return 0
        die "no Quake II data in '$data_dir': it should have a folder baseq2 with pak0.pak in it"
    fi
    while IFS= read -r place; do
        [[ -d $place ]] && normalise_data_dir "$place" && return 0
    done < <(list_usual_places)
    die "no Quake II data found in the usual places ($(list_usual_places | head -n 3 | paste -sd' ')...); name it: ./play --data DIR"
}

# Sets data_dir to what the engine gets, home_dir to where it writes.
prepare_game() {
    local own_data=$build_dir/game
    if [[ $find_data == yes ]]; then
        data_dir=$(choose_data) || exit 1
        note "Quake II data: $data_dir"
        [[ $game_name == baseq2 ]] || holds_data "$data_dir" "$game_name" \
            || die "no game '$game_name' in $data_dir: expected $data_dir/$game_name with its .pak files"
        prepare_run_dir home-data
    else
        data_dir=$own_data
        prepare_run_dir home
    fi
    data_dir=$(use_data "$data_dir") || exit 1
    if [[ -n $map_name && $find_data == no && ! -e $data_dir/baseq2/maps/$map_name.bsp ]]; then
        die "no map '$map_name' in our data; there are: $(list_maps | paste -sd' ')"
    fi
}
list_maps() { find "$data_dir/baseq2/maps/" -name '*.bsp' -printf '%f\n' | sed 's/\.bsp$//' | sort; }

# --- the engine's arguments ---------------------------------------------------------------------------------------

declare -a common_arguments=()
build_common_arguments() { # DEFAULT_SIZE
    local setting use=${size:-$1}
    common_arguments=()
    [[ $game_name == baseq2 ]] || common_arguments+=(+set game "$game_name")
    if [[ $fullscreen == yes ]]; then
        common_arguments+=(+set r_mode -2 +set vid_fullscreen 2)
    elif [[ -n $use ]]; then
        common_arguments+=(+set vid_fullscreen 0 +set r_mode -1 +set r_customwidth "${use%x*}" +set r_customheight "${use#*x}")
    fi
    for setting in ${settings[@]+"${settings[@]}"}; do
        common_arguments+=(+set "${setting%%=*}" "${setting#*=}")
    done
}

# True where a GPU (not the CPU driver) traces rays: it keeps up with larger pictures.
has_raytracing_gpu() {
    [[ -e /proc/driver/nvidia/version || -e /dev/nvidia0 ]] && return 0
    has vulkaninfo || return 1
    vulkaninfo 2>/dev/null | awk '
        /^GPU[0-9]+:/ { gpu = 1 }
        /deviceType *=/ { gpu = ($0 !~ /_CPU/) }
        gpu && /VK_KHR_ray_(query|tracing_pipeline) / { found = 1 }
        END { exit !found }'
}

is_first_start() { [[ ! -e $home_dir/.yq2/$game_name/config.cfg ]]; }

# The first start has no configuration yet: a size that the machine can keep up with.
first_size() {
    is_first_start || return 0
    if has_raytracing_gpu; then echo 1280x720; else echo 640x360; fi
}

# Where no GPU traces rays, the first start also sets a time that a frame may take: the engine keeps it with its settings.
declare -a first_settings=()
choose_first_settings() {
    is_first_start && ! has_raytracing_gpu || return 0
    first_settings=(+set pt_target_ms "$frame_ms_without_gpu")
    note "no GPU that traces rays was found: the 3D view is rendered smaller where that is needed for 30 frames a second"
    note "(console: pt_target_ms 0 turns that off; --set pt_target_ms=0 here)"
}
frame_ms_without_gpu=33

# --- playing ------------------------------------------------------------------------------------------------------

# Our game module goes around the game that is played: around the stock one in a game directory of its own, else in the
# mod's, from the home, which the engine searches first.
declare -a module_arguments=()
use_game_module() {
    local library folder=$home_dir/.yq2/$game_name
    [[ -e $run_dir/$own_game/game.so ]] || return 0
    if [[ $game_name == baseq2 ]]; then
        game_name=$own_game
        as_player mkdir -p "$home_dir/.yq2/$own_game"
        return
    fi
    for library in "$run_dir/$game_name/game.so" "$data_dir/$game_name/game.so"; do
        [[ -e $library ]] || continue
        as_player mkdir -p "$folder/models"
        as_player ln -sfn "$run_dir/$own_game/game.so" "$folder/game.so"
        as_player ln -sfn "$run_dir/$own_game/models/vkpt" "$folder/models/vkpt"
        module_arguments+=(+set vkpt_game_library "$library")
        return
    done
}

play_in_window() {
    local -a start=()
    share_display
    use_game_module
    build_common_arguments "$(first_size)"
    choose_first_settings
    # What the caller sets comes later, and so holds.
    common_arguments=(${first_settings[@]+"${first_settings[@]}"} "${common_arguments[@]}" ${module_arguments[@]+"${module_arguments[@]}"})
    # In a cooperative game the dead get up again by themselves.
    [[ $demo_mode == no ]] || common_arguments+=(+set coop 1 +set vkpt_start "walk explore 0")
    [[ -z $map_name && $find_data == no ]] && map_name=$own_map
    [[ -n $map_name ]] && start=(+map "$map_name")
    (exec_engine "$data_dir" ${common_arguments[@]+"${common_arguments[@]}"} "${start[@]}" "${engine_arguments[@]}")
    local status=$?
    if fallback_reason >/dev/null; then
        warn "ref_vkpt did not start and the engine used its own renderer. Its messages:"
        fallback_reason >&2
        return 1
    fi
    ((status == 0)) || die "the engine ended with status $status; its console is in $(console_log)"
}

# Sets demo_name to what the engine can open: a file of the user's is linked into the writable demo folder.
demo_name=
demo_blocks=0
choose_demo() {
    local folder=$home_dir/.yq2/$game_name/demos file
    demo_name=${demo:-$own_demo}
    [[ -z $demo && $find_data == yes ]] && demo_name=demo1.dm2
    [[ $demo_name == *.dm2 ]] || demo_name+=.dm2
    file=$demo_name
    [[ -f $file ]] || file=$data_dir/$game_name/demos/$demo_name
    [[ -f $file ]] || file=$data_dir/baseq2/demos/$demo_name
    if [[ ! -f $file ]]; then
        [[ $find_data == yes && $demo_name != */* ]] || die "no demo '$demo_name': neither a file nor in the game's demos/"
        return 0 # it may be in an archive
    fi
    demo_blocks=$(count_demo_blocks "$file")
    ((demo_blocks > 0)) || die "$file is not a Quake II demo (.dm2)"
    [[ $file == "$data_dir"/* ]] && return 0
    as_player mkdir -p "$folder"
    demo_name=${file##*/}
    install -m 644 "$file" "$folder/$demo_name" || die "cannot copy $file to $folder"
}

# A demo is a chain of blocks, each led by its length; nearly every block is one frame. 0: the chain is broken.
count_demo_blocks() {
    perl -e 'open(my $file, "<:raw", $ARGV[0]) or die; local $/; my $all = <$file>; my ($at, $count) = (0, 0);
        while ($at + 4 <= length $all) {
            my $length = unpack("l<", substr($all, $at, 4));
            last if $length == -1;
            if ($length < 0 || $at + 4 + $length > length $all) { $count = 0; last; }
            $at += 4 + $length; $count++;
        }
        print $count' "$1"
}

demo_progress() { last_line "$log_dir/engine.log"; }

# The engine stays up after a demo that it cannot open or a map that it lacks: end it then.
stop_on_error() {
    while sleep 0.5; do
        if grep -qE "^ERROR:|^Retrying with" "$(console_log)" 2>/dev/null; then
            sleep 0.5
            kill "$1" 2>/dev/null
            return
        fi
    done
}

# run_demo TITLE ARGUMENTS...: the demo through timedemo to its end, watched.
run_demo() {
    local title=$1 status=0 watcher reason
    shift
    rm -f "$(console_log)"
    (exec_engine "$data_dir" ${common_arguments[@]+"${common_arguments[@]}"} +set timedemo 1 +set cl_predict 0 +set nextdemo quit \
        +set pt_times 1 "$@" ${engine_arguments[@]+"${engine_arguments[@]}"} +demomap "$demo_name") >"$log_dir/engine.log" 2>&1 </dev/null &
    engine_pid=$!
    stop_on_error "$engine_pid" &
    watcher=$!
    watch_step "$engine_pid" "$title" demo_progress || status=$?
    engine_pid=
    kill "$watcher" 2>/dev/null
    wait "$watcher" 2>/dev/null
    reason=$(fallback_reason) && die "ref_vkpt could not start: $reason"
    grep -q '^ERROR:' "$(console_log)" && die "the engine: $(sed -n 's/^ERROR: //p' "$(console_log)" | head -n 1)"
    ((status == 0)) || die "the engine ended with status $status; its console is in $(console_log)"
}

print_figures() {
    local line
    line=$(grep -oE '[0-9]+ frames, [0-9.]+ seconds: [0-9.]+ fps' "$(console_log)" | tail -n 1)
    [[ -n $line ]] || die "the engine printed no frame rate; its console is in $(console_log)"
    say "Engine:  $line"
    grep '^ref_vkpt: pass ' "$(console_log)" | sed 's/^ref_vkpt: pass /Pass:    /'
    return 0
}

play_timedemo() {
    share_display
    build_common_arguments "$(first_size)"
    choose_demo
    run_demo "Playing $demo_name"
    print_figures
}

# Without a display: the engine plays the demo once, in no time, for a trace of it; `vkpt` replays that through the module.
# A timedemo goes through the engine itself, in a virtual display.
play_headless() {
    local use=${size:-640x360}
    size=$use
    fullscreen=no
    if [[ -n $map_name ]]; then
        die "--map needs a display; without one only demos are played (--timedemo DEMO)"
    fi
    if [[ $timedemo == yes ]]; then
        build_common_arguments "$use"
        start_xvfb "${use%x*}" "${use#*x}"
        choose_demo
        run_demo "Playing $demo_name in a virtual display, $use" +set s_openal 0 +set s_sdldriver dummy
        print_figures
    else
        film_demo "$use"
    fi
}

# Where vkpt keeps and writes things: it uses nothing that another user has made, and for root the engine's cache is the
# player's.
program_cache_dir() { if ((player_uid == $(id -u))); then echo "$cache_dir"; else echo "$cache_dir-root"; fi; }

# vkpt_program COMMAND...: with the caches of every run.
vkpt_program() {
    local cache
    cache=$(program_cache_dir)
    XDG_CACHE_HOME=$cache VKPT_CACHE_DIR=$cache "$build_dir/bin/vkpt" "$@"
}

# A tenth of a second a frame is what a CPU can draw in minutes; a GPU is given three times as many.
film_rate() { if has_raytracing_gpu; then echo 30; else echo 10; fi; }

# film_demo WxH: every frame of the demo as a picture, some of them, a contact sheet and a film to $out_dir.
film_demo() {
    local use=$1 rate mode=() trace=$home_dir/demo.rtrace setting
    local -a data=(--basedir "$data_dir" --game "$game_name") given=()
    check_out_dir "$out_dir"
    take_set_arguments ${engine_arguments[@]+"${engine_arguments[@]}"}
    for setting in ${settings[@]+"${settings[@]}"}; do
        given+=(--set "$setting")
    done
    choose_demo
    rate=$(film_rate)
    if ((rate == 10)); then mode=(--timedemo); else mode=(--rate "$rate"); fi
    rm -f "$trace"
    run_step record "Recording $demo_name by the engine" vkpt_program record "${demo:-$demo_name}" "${mode[@]}" \
        --engine "$(find_engine)" --size "$use" "${data[@]}" ${given[@]+"${given[@]}"} -o "$trace" || exit 1
    film_frames=$(vkpt_program info --json "$trace" | perl -MJSON::PP -e 'local $/; print decode_json(<STDIN>)->{frames}') \
        || die "$trace cannot be read"
    capture_path=$(program_cache_dir)/vkpt/vkpt/captures/$capture_folder
    rm -rf "$capture_path"
    mkdir -p "${capture_path%/*}" || die "cannot write to ${capture_path%/*}"
    vkpt_program render "$trace" --frames "$film_frames" --size "$use" --seed 0 "${data[@]}" \
        --set pt_capture_dir="$capture_folder" --set pt_capture_every=1 --set pt_capture_mib=1000000 ${given[@]+"${given[@]}"} -o "$capture_path.png" \
        >"$log_dir/film.log" 2>&1 </dev/null &
    engine_pid=$!
    if ! watch_step "$engine_pid" "Rendering $film_frames frames of $demo_name, $use" film_progress; then
        tail -n 5 "$log_dir/film.log" >&2
        die "the demo could not be replayed"
    fi
    engine_pid=
    rm -f "$capture_path.png"
    collect_pictures "$out_dir" "$rate"
    rm -rf "$capture_path"
}

# What is left of the command line: only +set NAME VALUE means something without the engine's window.
take_set_arguments() {
    while (($#)); do
        [[ $1 == +set && $# -ge 3 ]] || die_usage "without a display, ENGINE ARGUMENT is +set NAME VALUE, not '$1'"
        settings+=("$2=$3")
        shift 3
    done
}

# What this machine makes of our demo and our map.
report_gpu() {
    local trace=$home_dir/demo.rtrace setting
    local -a given=()
    for setting in ${settings[@]+"${settings[@]}"}; do
        given+=(--set "$setting")
    done
    [[ -z $size ]] || given+=(--size "$size")
    choose_demo
    rm -f "$trace"
    run_step record "Recording $demo_name by the engine" vkpt_program record "$demo_name" --timedemo \
        --engine "$(find_engine)" --basedir "$data_dir" -o "$trace" || exit 1
    mkdir -p "${report_dir%/*}" 2>/dev/null
    vkpt_program report "$trace" --basedir "$data_dir" ${given[@]+"${given[@]}"} -o "$report_dir" || die "there is no report"
}

film_frames=0 capture_path=
film_progress() {
    local -a pictures=("$capture_path"/*.png)
    local done=${#pictures[@]} left
    if [[ ! -e ${pictures[0]} ]]; then
        echo "starting the renderer"
        return
    fi
    # From the first picture on: before it, the driver compiles.
    left=$((($(date +%s) - $(stat -c %Y "${pictures[0]}")) * (film_frames - done) / (done > 1 ? done - 1 : 1)))
    printf '%d of %d frames, about %d:%02d left\n' "$done" "$film_frames" $((left / 60)) $((left % 60))
}

# What ./play wrote to a folder is listed there, and no other file of it is ever removed or written over.
pictures_list=.ref_vkpt-pictures
list_own_pictures() { [[ -f $1/$pictures_list ]] && grep -xE 'frame[0-9]+\.png|contact_sheet\.png|demo\.mp4' "$1/$pictures_list"; }

# check_out_dir OUT: ends the script where somebody else's files have the names of ours.
check_out_dir() {
    local out=$1 file
    if ! mkdir -p "$out" 2>/dev/null || [[ ! -w $out ]]; then die "cannot write to $out"; fi
    # The checkout's own out/ is ours, also where an earlier version kept no list.
    [[ -L $root/out || ! $out -ef $root/out || -e $out/$pictures_list ]] || find "$out" -maxdepth 1 -type f -printf '%f\n' >"$out/$pictures_list"
    for file in "$out"/frame*.png "$out/contact_sheet.png" "$out/demo.mp4"; do
        [[ -e $file || -L $file ]] || continue
        list_own_pictures "$out" | grep -xF "${file##*/}" >/dev/null \
            || die "$file is there, and ./play did not write it; move it away, or name another folder: --out DIR"
    done
}
clear_out_dir() {
    local name
    list_own_pictures "$1" | while IFS= read -r name; do rm -f "$1/$name"; done
}

# collect_pictures OUT RATE: some of the frames, the contact sheet of them, and where ffmpeg is there, a film of all.
collect_pictures() {
    local out=$1 rate=$2 wanted=${VKPT_PICTURES:-24} i every made
    local -a pictures=("$capture_path"/frame*.png) chosen=()
    [[ -e ${pictures[0]} ]] || { tail -n 5 "$log_dir/film.log" >&2; die "the module wrote no pictures"; }
    every=$((${#pictures[@]} / wanted))
    ((every > 0)) || every=1
    for ((i = 0; i < ${#pictures[@]}; i += every)); do
        chosen+=("${pictures[i]}")
    done
    clear_out_dir "$out"
    rm -f "$out/$pictures_list"
    printf '%s\n' "${chosen[@]##*/}" contact_sheet.png demo.mp4 >"$out/$pictures_list" || die "cannot write to $out"
    cp --no-preserve=ownership "${chosen[@]}" "$out/" || die "cannot write to $out"
    "$build_dir/scripts/contact_sheet" "$out/contact_sheet.png" "${chosen[@]}" || die "the contact sheet could not be made"
    made="${#chosen[@]} pictures and contact_sheet.png"
    if ! has ffmpeg; then
        note "no ffmpeg, so no video: install it (apt install ffmpeg) and run ./play again"
    elif make_film "$out/demo.mp4" "$rate"; then
        made="${#chosen[@]} pictures, contact_sheet.png and demo.mp4"
    else
        warn "ffmpeg made no video; its output is in $log_dir/ffmpeg.log"
    fi
    say "$made are in $out"
}

# make_film FILE RATE: H.264 where ffmpeg can write it. The format wants even sizes.
make_film() {
    local file=$1 rate=$2
    local -a codec=(-c:v mpeg4 -q:v 2)
    [[ $(ffmpeg -hide_banner -encoders 2>/dev/null) == *libx264* ]] && codec=(-c:v libx264 -crf 18)
    run_step ffmpeg "Writing ${file##*/}" ffmpeg -hide_banner -y -framerate "$rate" -i "$capture_path/frame%06d.png" \
        -vf "pad=ceil(iw/2)*2:ceil(ih/2)*2" "${codec[@]}" -pix_fmt yuv420p -movflags +faststart "$file.part.mp4" \
        && mv "$file.part.mp4" "$file" && return 0
    rm -f "$file.part.mp4"
    return 1
}
