#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What the set-up makes of every kind of apt sources that Debian machines have.
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
is_root() { true; } # the folder is ours, so nobody else is needed

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

new_machine
echo 'deb http://deb.debian.org/debian bookworm main' >"$VKPT_APT_DIR/sources.list"
write_own_sources "$(missing_sources no)"
write_own_sources "$(missing_sources yes)"
expect_equal "what is added later keeps what was there" '' "$(missing_sources yes)"
expect_equal "no contrib where nothing of it is missing" 'Suites: bookworm-backports' "$(new_machine; missing_sources yes no | grep Suites)"

((failures == 0)) && echo "set-up: all as it should be"
((failures == 0))
