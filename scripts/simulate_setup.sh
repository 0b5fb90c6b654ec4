#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What ./play or ./test would install, with Debian's archive as it is today, on machines that are only lists of packages:
# Debian 12 without a GPU, one with a GPU and its drivers, Debian 13. Changes nothing, needs the network, not root.
#
#   scripts/simulate_setup.sh [play|test]
# shellcheck disable=SC2034,SC2317  # variables and functions of the scripts are replaced
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
help_if_asked "$@"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export VKPT_APT_DIR=$folder/apt VKPT_RECORD_DIR=$folder/record
. "$root/scripts/lib/setup.sh"
needed_for=${1:-test}
log_dir=$folder/log plan_dir=$folder/plan apt_lists=$folder/lists dpkg_dir=$folder/dpkg dev_dir=$folder/dev no_mesa_stamp=$folder/stamp no_shim_stamp=$folder/shim-stamp
is_debian() { true; }
has_agreed() { false; }
has_terminal() { false; }
release_codename() { echo "$simulated_release"; }
release_number() { echo "$simulated_number"; }
apt_extra_settings='APT::Sandbox::User ""; Dir::State::extended_states "/dev/null";'

machine_apt() {
    LC_ALL=C "$1" -o Dir::Etc::SourceList="$folder/apt/sources.list" -o Dir::Etc::SourceParts="$folder/apt/sources.list.d" \
        -o Dir::State::Lists="$folder/lists" -o Dir::State::status="$folder/dpkg/status" -o Dir::State::extended_states=/dev/null \
        -o Dir::Cache="$folder/cache" -o Debug::NoLocking=1 -o APT::Sandbox::User= "${@:2}"
}

# make_machine RELEASE PACKAGE...: its basic packages and these, with all that they depend on, as "installed".
make_machine() {
    local -a base versions
    mkdir -p "$folder"/{apt/sources.list.d,dpkg/info,dpkg/updates,cache,log,dev,lists}
    : >"$folder/dpkg/status"
    echo "deb [signed-by=$debian_keyring] http://deb.debian.org/debian $1 main" >"$folder/apt/sources.list"
    machine_apt apt-get -qq update || die "Debian's archive cannot be reached"
    mapfile -t base < <(machine_apt apt-cache dumpavail | awk -v RS='' '/\nPriority: (required|important)\n/ { print $2 }')
    mapfile -t versions < <(machine_apt apt-get -s install --no-install-recommends "${base[@]}" "${@:2}" | read_simulation | awk '{ print $2 "=" $3 }')
    machine_apt apt-cache show "${versions[@]}" | sed 's/^Package: .*/&\nStatus: install ok installed/' >"$folder/status"
    mv "$folder/status" "$folder/dpkg/status"
}

# simulate TITLE RELEASE NUMBER GPU PACKAGE...
simulate() {
    say "=== $1"
    simulated_release=$2 simulated_number=$3
    rm -rf "${folder:?}"/*
    make_machine "$2" "${@:5}"
    [[ $4 == no ]] || { mkdir -p "$folder/dev/dri" && : >"$folder/dev/dri/renderD128"; }
    say "a machine of $(grep -c ^Package: "$folder/dpkg/status") packages"
    (set_up_machine)
    say
}
desktop=(systemd-sysv udev libpam-systemd libgl1-mesa-dri mesa-vulkan-drivers xserver-xorg-core xwayland pipewire libsdl2-2.0-0)
simulate "Debian 12, plain" bookworm 12 no
simulate "Debian 12, a desktop without a GPU" bookworm 12 no "${desktop[@]}"
simulate "Debian 12, a desktop with a GPU" bookworm 12 yes "${desktop[@]}"
simulate "Debian 13, plain" trixie 13 no
simulate "Debian 13, a desktop with a GPU" trixie 13 yes "${desktop[@]}"
