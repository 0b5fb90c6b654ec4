# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# Messages, long steps with progress, and the few facts that every script needs. Sourced, never run.
# `root` is the checkout; the sourcing script sets it.

: "${root:?common.sh is sourced by ./play, ./test and scripts/*.sh}"
# shellcheck disable=SC2034
build_dir=${VKPT_BUILD_DIR:-$root/build/release}
if [[ $build_dir != /* ]]; then # what is called from here may work in another folder
    build_dir=$PWD/$build_dir
    export VKPT_BUILD_DIR=$build_dir
fi
log_dir=$root/build/log
seconds_between_lines=10 # of progress, where there is no terminal

say() { printf '%s\n' "$*"; }
note() { printf '   %s\n' "$*"; }
warn() { printf 'warning: %s\n' "$*" >&2; }
# help_if_asked ARGUMENT...: where the first one asks for help, the comment at the head of the script, and that is all.
help_if_asked() {
    [[ ${1:-} == -h || ${1:-} == --help ]] || return 0
    awk 'NR > 2 && !/^#/ { exit } NR > 2 { sub(/^# ?/, ""); print }' "$root/scripts/$(basename -- "$0")"
    exit 0
}
die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}
die_usage() {
    printf '%s: %s\n' "${0##*/}" "$1" >&2
    printf "Try './%s --help'.\n" "${0##*/}" >&2
    exit 2
}

# Reads "[--check] [FOLDER]" into `check` (yes or no) and `top` (default: the whole source tree).
read_check_options() {
    check=no
    [[ ${1:-} == --check ]] && { check=yes; shift; }
    # shellcheck disable=SC2034
    top=${1:-$root}
    [[ -d $top ]] || die_usage "$top is not a folder"
}

is_root() { [[ $(id -u) -eq 0 ]]; }
has() { command -v "$1" >/dev/null 2>&1; }
has_terminal() { [[ -t 0 && -t 1 ]]; }

# Whether somebody agreed beforehand: by --yes, or by CI, which build servers set.
answer_yes=no
has_agreed() { [[ $answer_yes == yes || ! ${CI:-no} =~ ^(no|false|0)$ ]]; }

# ask QUESTION: true for yes. Whoever merely pipes our output, or has no terminal, has not said yes.
ask() {
    local answer
    has_agreed && return 0
    has_terminal || return 1
    read -r -p "$1 [Y/n] " answer || return 1
    [[ -z $answer || $answer == [yY]* ]]
}

# Everything that the scripts write is below build/ and out/ of the checkout.
check_writable() {
    if ! mkdir -p "$log_dir" 2>/dev/null || [[ ! -w $log_dir ]]; then
        die "$(id -un) cannot write to $log_dir (the folder of $(stat -c %U "$root"); an earlier run as another user?). \
Own the checkout, or remove its build/ and start again."
    fi
}

# The last non-empty line of a log without control codes, cut to the terminal.
last_line() {
    local columns=${COLUMNS:-$(tput cols 2>/dev/null || echo 80)}
    tail -c 4000 "$1" 2>/dev/null | tr '\r' '\n' | sed -e 's/\x1b\[[0-9;]*[A-Za-z]//g' -e '/^[[:space:]]*$/d' | tail -n 1 \
        | cut -c "1-$((columns > 30 ? columns - 14 : 60))"
}

# watch_step PID TITLE PROGRESS...: shows what PROGRESS prints until PID has ended; returns its status. Silent where
# the step is over at once.
watch_step() {
    local pid=$1 title=$2 start=$SECONDS shown=$SECONDS tick announced=no
    shift 2
    for ((tick = 0;; tick++)); do
        kill -0 "$pid" 2>/dev/null || break
        sleep 0.1
        ((tick >= 7)) || continue
        if [[ $announced == no ]]; then
            say "-- $title"
            announced=yes
        elif [[ -t 1 ]]; then
            printf '\r\033[K   %3d s  %s' $((SECONDS - start)) "$("$@")"
        elif ((SECONDS - shown >= seconds_between_lines)); then
            shown=$SECONDS
            printf '   %3d s  %s\n' $((SECONDS - start)) "$("$@")"
        fi
    done
    local status=0
    wait "$pid" || status=$?
    if [[ $announced == yes ]]; then
        [[ -t 1 ]] && printf '\r\033[K'
        ((status == 0)) && note "done in $((SECONDS - start)) s"
    fi
    return "$status"
}

# run_step NAME TITLE COMMAND...: the output goes to build/log/NAME.log, its last line is the progress.
run_step() {
    local name=$1 title=$2 log
    shift 2
    check_writable
    log=$log_dir/$name.log
    "$@" >"$log" 2>&1 </dev/null &
    if ! watch_step $! "$title" last_line "$log"; then
        tail -n 40 "$log" >&2
        warn "$title: failed; the full output is in ${log#"$root"/}"
        return 1
    fi
}
