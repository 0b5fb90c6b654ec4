#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The set-up's decisions, with every kind of apt sources that Debian machines have, and with apt played by functions.
# shellcheck disable=SC2034,SC2317  # the functions below replace those of the scripts
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export VKPT_APT_DIR=$folder/apt
. "$root/scripts/lib/common.sh"
. "$root/scripts/lib/setup.sh"
failures=0
expect_equal() { # NAME WANTED GOT
    [[ $2 == "$3" ]] && return 0
    printf 'FAILED: %s\n--- wanted\n%s\n--- got\n%s\n' "$1" "$2" "$3"
    failures=$((failures + 1))
}
new_machine() { # fresh sources
    rm -rf "$VKPT_APT_DIR"
    mkdir -p "$VKPT_APT_DIR/sources.list.d"
}
release_codename() { echo bookworm; }

new_machine
cat >"$VKPT_APT_DIR/sources.list" <<'SOURCES'
# deb http://old.example/debian bookworm contrib
deb http://deb.debian.org/debian bookworm main # the archive
deb-src http://deb.debian.org/debian bookworm main contrib
deb http://deb.debian.org/debian bookworm-updates main
SOURCES
expect_equal "classic sources without Signed-By" 'Types: deb
URIs: http://deb.debian.org/debian
Suites: bookworm
Components: contrib

Types: deb
URIs: http://deb.debian.org/debian
Suites: bookworm-backports
Components: main' "$(missing_sources yes)"
expect_equal "no backports wanted" 'Types: deb
URIs: http://deb.debian.org/debian
Suites: bookworm
Components: contrib' "$(missing_sources no)"

new_machine
echo 'deb [arch=amd64 signed-by=/usr/share/keyrings/k.gpg] http://mirror.example/debian/ bookworm main contrib non-free' \
    >"$VKPT_APT_DIR/sources.list.d/site.list"
expect_equal "one line with options; contrib is there" 'Types: deb
URIs: http://mirror.example/debian/
Suites: bookworm-backports
Components: main
Signed-By: /usr/share/keyrings/k.gpg' "$(missing_sources yes)"

new_machine
cat >"$VKPT_APT_DIR/sources.list.d/debian.sources" <<'SOURCES'
Types: deb deb-src
# a comment
URIs: http://deb.debian.org/debian
Suites: bookworm bookworm-updates
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg

Types: deb
URIs: http://deb.debian.org/debian
Suites: bookworm-backports
Components: main contrib
Enabled: no

Types: deb
URIs: http://deb.debian.org/debian-security
Suites: bookworm-security
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
SOURCES
expect_equal "deb822 with Signed-By, backports disabled" 'Types: deb
URIs: http://deb.debian.org/debian
Suites: bookworm
Components: contrib
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg

Types: deb
URIs: http://deb.debian.org/debian
Suites: bookworm-backports
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg' "$(missing_sources yes)"
write_own_sources "$(missing_sources yes)"
expect_equal "nothing is missing once it is written" '' "$(missing_sources yes)"

new_machine
cat >"$VKPT_APT_DIR/sources.list.d/debian.sources" <<'SOURCES'
Types: deb
URIs: http://deb.debian.org/debian
Suites: bookworm
Components: main
Signed-By:
 -----BEGIN PGP PUBLIC KEY BLOCK-----
 .
 mDMEZ
 -----END PGP PUBLIC KEY BLOCK-----
SOURCES
expect_equal "a key inline is not copied" 'http://deb.debian.org/debian|inline' "$(debian_archive)"

new_machine
expect_equal "no Debian entry at all" "http://deb.debian.org/debian|$debian_keyring" "$(debian_archive)"

# --- the whole set-up against a pretended apt: what it calls, in which order
log_dir=$folder/log
no_mesa_stamp=$log_dir/no-newer-mesa
calls=$folder/calls
mkdir -p "$log_dir"
as_root() { "$@"; }
check_can_install() { :; }
is_interactive() { false; }
is_debian() { true; }
has_raytracing_gpu() { [[ $pretend_gpu == yes ]]; }
find_missing_packages() { grep -qx packages "$folder/installed" 2>/dev/null || printf 'cmake\nyamagi-quake2\n'; }
installed_version() { cat "$folder/mesa" 2>/dev/null; }
candidate_version() {
    case $1 in
    mesa-vulkan-drivers) echo "$pretend_mesa" ;;
    yamagi-quake2) has_source bookworm contrib && echo 8.20 ;;
    esac
}
run_apt() {
    echo "$*" >>"$calls"
    case "$*" in
    *'-t bookworm-backports'*) echo 25.0.7-2 >"$folder/mesa" ;;
    *mesa-vulkan-drivers*) echo "$pretend_mesa" >"$folder/mesa" ;;
    *yamagi-quake2*) echo packages >"$folder/installed" ;;
    esac
}
pretend_set_up() { # GPU MESA-OF-THE-RELEASE
    new_machine
    pretend_gpu=$1
    pretend_mesa=$2
    echo 'deb http://deb.debian.org/debian bookworm main' >"$VKPT_APT_DIR/sources.list"
    rm -f "$calls" "$folder/installed" "$folder/mesa" "$no_mesa_stamp"
    (set_up_machine) >"$folder/output" 2>&1 || { cat "$folder/output"; expect_equal "set-up ended" 0 1; }
    cat "$calls"
}
expect_equal "Debian 12: backports first" 'update
update
install -y --no-install-recommends -t bookworm-backports mesa-vulkan-drivers libsdl2-dev
install -y --no-install-recommends cmake yamagi-quake2' "$(pretend_set_up no 22.3.6-1)"
: >"$calls"
(set_up_machine) >/dev/null 2>&1
expect_equal "a second time: no call at all" '' "$(cat "$calls")"
expect_equal "a newer release: its own Mesa" 'update
update
install -y --no-install-recommends mesa-vulkan-drivers
install -y --no-install-recommends cmake yamagi-quake2' "$(pretend_set_up no 25.0.7-2)"
expect_equal "a GPU that traces rays keeps its driver" 'update
update
install -y --no-install-recommends cmake yamagi-quake2' "$(pretend_set_up yes 22.3.6-1)"

((failures == 0)) && echo "set-up: all as it should be"
((failures == 0))
