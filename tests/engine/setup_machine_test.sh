#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The whole set-up, and its taking back, on machines of several kinds: apt itself decides, over a small archive of our own.
# What it would do to a machine is compared line by line; nothing real is touched, no network is needed.
# shellcheck disable=SC2034,SC2317  # the functions below replace those of the scripts
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
if ! command -v apt-get >/dev/null; then
    echo "no apt on this system"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export VKPT_APT_DIR=$folder/machine/apt VKPT_RECORD_DIR=$folder/machine/record/ref_vkpt
. "$root/scripts/lib/common.sh"
. "$root/scripts/lib/setup.sh"
. "$root/scripts/lib/uninstall.sh"
. "$root/tests/engine/fake_archive.sh"
unset CI
failures=0
expect_equal() { # NAME WANTED GOT
    [[ $2 == "$3" ]] && return 0
    printf 'FAILED: %s\n--- wanted\n%s\n--- got\n%s\n' "$1" "$2" "$3"
    diff <(printf '%s\n' "$2") <(printf '%s\n' "$3") | head -n 20
    failures=$((failures + 1))
}
expect_says() { # NAME PATTERN
    grep -qE -- "$2" "$folder/output" && return 0
    printf 'FAILED: %s did not say "%s":\n%s\n' "$1" "$2" "$(cat "$folder/output")"
    failures=$((failures + 1))
}

# --- the archive --------------------------------------------------------------------------------------------------

drm_parts=(amdgpu1 intel1 nouveau2 radeon1)
# add_desktop SUITE SYSTEMD WAYLAND LIBDRM MESA SDL MESA-NEEDS: the part of Debian that a newer Mesa may draw along.
add_desktop() {
    local suite=$1 systemd=$2 wayland=$3 drm=$4 mesa=$5 sdl=$6 part
    add_package "$suite" main systemd "$systemd"
    add_package "$suite" main libudev1 "$systemd"
    add_package "$suite" main udev "$systemd" "libudev1 (= $systemd)"
    add_package "$suite" main libudev-dev "$systemd" "libudev1 (= $systemd)"
    add_package "$suite" main libwayland-client0 "$wayland"
    add_package "$suite" main libwayland-dev "$wayland" "libwayland-client0 (= $wayland)"
    add_package "$suite" main libdrm-common "$drm"
    add_package "$suite" main libdrm2 "$drm" "libdrm-common (>= $drm)"
    for part in "${drm_parts[@]}"; do
        add_package "$suite" main "libdrm-$part" "$drm" "libdrm2 (>= $drm)"
    done
    add_package "$suite" main libdrm-dev "$drm" "libdrm2 (= $drm)$(printf ", libdrm-%s (= $drm)" "${drm_parts[@]}")"
    add_package "$suite" main libgbm1 "$mesa" "libdrm2 (>= $drm), libwayland-client0"
    add_package "$suite" main libgbm-dev "$mesa" "libgbm1 (= $mesa)"
    add_package "$suite" main libgl1-mesa-dri "$mesa" "libdrm2 (>= $drm), libdrm-radeon1, libdrm-nouveau2, libdrm-intel1, libdrm-amdgpu1"
    add_package "$suite" main mesa-vulkan-drivers "$mesa" "libdrm2 (>= $drm), libdrm-amdgpu1 (>= $drm), libwayland-client0"
    add_package "$suite" main libsdl2-dev "$sdl" "libdrm-dev, libgbm-dev, libudev-dev, libwayland-dev"
}
# The rest of scripts/packages.txt, and a C library whose development package wants it in exactly its own version.
add_the_rest() {
    local name libc=$2
    while IFS= read -r name; do
        case $name in
        libsdl2-dev) ;;
        build-essential) add_package "$1" main build-essential 12 libc6-dev ;;
        xvfb) add_package "$1" main xvfb 21 libgl1-mesa-dri ;;
        yamagi-quake2*) add_package "$1" contrib "$name" 8 ;;
        *) add_package "$1" main "$name" 1 ;;
        esac
    done < <(read_package_list)
    add_package "$1" main libc6 "$libc"
    add_package "$1" main libc6-dev "$libc" "libc6 (= $libc)"
    add_package "$1" main other-program 1 libpng-dev
}
bookworm=(252.39-1 1.21.0-1 2.4.114-1+b1 22.3.6-1+deb12u1 2.26.5-1)
backports=(254.26-1~bpo12+1 1.23.0-1~bpo12+1 2.4.123-1~bpo12+1 25.0.7-2~bpo12+1 2.30.0-1~bpo12+1)
add_desktop bookworm "${bookworm[@]}"
add_the_rest bookworm 2.36-9+deb12u13
add_desktop bookworm-backports "${backports[@]}"
add_desktop trixie 257.13-1 1.23.1-3 2.4.124-2 25.0.7-2 2.32.4-1
add_the_rest trixie 2.41-12
# Older builds of the same release, as on a machine that was not kept up to date. No suite lists them any more.
add_package old main libc6 2.36-9+deb12u1
add_package old main libudev1 252.1-1
add_package old main udev 252.1-1 "libudev1 (= 252.1-1)"
for version in 22.3.6-1 22.3.5-1; do
    add_package old main libgl1-mesa-dri $version
    add_package old main libgbm1 $version "libgl1-mesa-dri (= $version)"
done
add_package bookworm-backports main mesa-drm-shim 25.0.7-2~bpo12+1 libc6
add_package trixie main mesa-drm-shim 25.0.7-2 libc6
finish_suite bookworm 12.12 Debian
finish_suite bookworm-backports '' 'Debian Backports' 'NotAutomatic: yes
ButAutomaticUpgrades: yes'
finish_suite trixie 13.2 Debian
listed=$(read_package_list | grep -cv '^libsdl2-dev$')

# --- machines -----------------------------------------------------------------------------------------------------

log_dir=$folder/log
no_mesa_stamp=$log_dir/no-newer-mesa no_shim_stamp=$log_dir/no-drm-shim
plan_dir=$folder/plan
apt_lists=$machine/lists dpkg_dir=$machine/dpkg apt_marks=$machine/extended_states dev_dir=$machine/dev proc_dir=$machine/proc vulkan_dir=$machine/vulkan
is_root() { true; }
is_debian() { true; }
has_terminal() { false; }
run_apt() { play_apt "$@"; }
system_apt() { fake_apt apt-get "$@"; }
apt-mark() { fake_apt "$(type -P apt-mark)" "$@"; }
release_codename() { echo "$suite_of_machine"; }
release_number() { [[ $suite_of_machine == trixie ]] && echo 13 || echo 12; }

# start_machine SUITE PACKAGE...: a machine of that release with these packages, NAME or NAME=VERSION.
start_machine() {
    local package
    local -a newest=() named=()
    suite_of_machine=$1
    new_machine "$1"
    apt_extra_settings=$(print_machine_settings)
    rm -rf "$log_dir"
    answer_yes=yes
    for package in libc6 systemd libudev1 udev "${@:2}"; do
        if [[ $package == *=* ]]; then named+=("${package/=/ }"); else newest+=("$package"); fi
    done
    {
        fake_apt apt-cache policy "${newest[@]}" | awk '/^[^ ]/ { sub(/:$/, ""); name = $0 } $1 == "Candidate:" { print name, $2 }'
        ((${#named[@]} == 0)) || printf '%s\n' "${named[@]}"
    } | change_fakes
}
set_up() { (set_up_machine) >"$folder/output" 2>&1; }
# The last run's changes, but for the many packages of the list without dependencies: how many, and what else.
print_changes() {
    read_simulation <"$machine/simulation" | awk '$1 != "new" || $3 !~ /^(1|8|12|21)$/ { print; next } { listed++ } END { print listed + 0, "of the list" }'
}
print_sources() { grep -hE '^(Suites|Components)' "$machine/apt/sources.list.d/"* 2>/dev/null | paste -sd' '; }
gpu() { : >"$machine/dev/dri/renderD128"; mkdir -p "$machine/vulkan/usr/share/vulkan/icd.d"; : >"$machine/vulkan/usr/share/vulkan/icd.d/radeon_icd.json"; }

mesa_from_backports="new libdrm-amdgpu1 2.4.123-1~bpo12+1
new libdrm-common 2.4.123-1~bpo12+1
new libdrm-dev 2.4.123-1~bpo12+1
new libdrm-intel1 2.4.123-1~bpo12+1
new libdrm-nouveau2 2.4.123-1~bpo12+1
new libdrm-radeon1 2.4.123-1~bpo12+1
new libdrm2 2.4.123-1~bpo12+1"
of_the_release="new libgbm-dev 22.3.6-1+deb12u1
new libgbm1 22.3.6-1+deb12u1
new libgl1-mesa-dri 22.3.6-1+deb12u1
new libsdl2-dev 2.26.5-1
new libudev-dev 252.39-1
new libwayland-client0 1.21.0-1
new libwayland-dev 1.21.0-1"

start_machine bookworm
set_up || expect_equal "plain Debian 12: status" 0 1
expect_equal "plain Debian 12" "new libc6-dev 2.36-9+deb12u13
$mesa_from_backports
$of_the_release
new mesa-drm-shim 25.0.7-2~bpo12+1
new mesa-vulkan-drivers 25.0.7-2~bpo12+1
$listed of the list" "$(print_changes | sort | sed '/of the list/d'; print_changes | tail -n 1)"
expect_equal "plain Debian 12: sources" 'Suites: bookworm Components: contrib Suites: bookworm-backports Components: main' "$(print_sources)"
expect_equal "no pins are left" '' "$(find "$machine/apt" -path '*preferences*' -type f)"
expect_says "plain Debian 12" 'libdrm2 2\.4\.123-1~bpo12\+1'
expect_equal "only Mesa and the list are wanted for their own sake" '' "$(fake_apt apt-mark showmanual | grep -E '^libdrm-?(2|common|amd|int|nou|rad)')"
rm "$machine/calls"
answer_yes=no
set_up || expect_equal "a second time: status" 0 1
expect_equal "a second time: silent, and no call at all" '' "$(cat "$machine/calls" 2>/dev/null)$(cat "$folder/output")"

# Taken back: all of it, but for what another program needs by now.
install_fake other-program 1
(uninstall_from_machine) >"$folder/output" 2>&1
expect_equal "taking back needs a yes" 1 $?
expect_says "taking back without a terminal" '--uninstall --yes'
[[ -n $(has_fake mesa-vulkan-drivers) ]] || expect_equal "nothing is taken back without a yes" there gone
answer_yes=yes
(uninstall_from_machine) >"$folder/output" 2>&1 || expect_equal "taking back: status" 0 "$(cat "$folder/output")"
expect_says "taking back" 'mesa-vulkan-drivers 25\.0\.7-2~bpo12\+1'
expect_says "what others need stays" 'need them by now: libpng-dev'
expect_equal "what is left" 'libc6 libpng-dev libudev1 other-program systemd udev' \
    "$(dpkg-query --admindir="$machine/dpkg" -W -f '${Package}\n' | sort | paste -sd' ')"
expect_equal "no source, no record is left" '' "$(print_sources; ls "$machine/record")"
(uninstall_from_machine) >"$folder/output" 2>&1 || expect_equal "a second time: status" 0 1
expect_says "a second time" 'Nothing to remove'

start_machine bookworm libdrm2 libdrm-common libdrm-amdgpu1 libdrm-intel1 libdrm-nouveau2 libdrm-radeon1 libgbm1 libgl1-mesa-dri libwayland-client0 mesa-vulkan-drivers
set_up || expect_equal "a desktop without a GPU: status" 0 1
expect_equal "a desktop without a GPU: libdrm and Mesa's Vulkan drivers alone are newer" \
    'upgrade libdrm-amdgpu1 upgrade libdrm-common upgrade libdrm-intel1 upgrade libdrm-nouveau2 upgrade libdrm-radeon1 upgrade libdrm2 upgrade mesa-vulkan-drivers' \
    "$(print_changes | sed -n 's/^\(upgrade [^ ]*\|remove [^ ]*\).*/\1/p' | paste -sd' ')"
expect_says "an upgrade is named" 'mesa-vulkan-drivers 22\.3\.6-1\+deb12u1 to 25\.0\.7-2~bpo12\+1'
(uninstall_from_machine) >"$folder/output" 2>&1 || expect_equal "taking back: status" 0 "$(cat "$folder/output")"
expect_equal "the earlier versions come back" '22.3.6-1+deb12u1 2.4.114-1+b1' "$(has_fake mesa-vulkan-drivers) $(has_fake libdrm2)"

start_machine bookworm libdrm2 libdrm-common libdrm-amdgpu1 libdrm-intel1 libdrm-nouveau2 libdrm-radeon1 libgl1-mesa-dri libwayland-client0 mesa-vulkan-drivers
gpu
set_up || expect_equal "a GPU: status" 0 1
expect_equal "a GPU keeps its drivers" "new libc6-dev 2.36-9+deb12u13
new libdrm-dev 2.4.114-1+b1
new libgbm-dev 22.3.6-1+deb12u1
new libgbm1 22.3.6-1+deb12u1
new libsdl2-dev 2.26.5-1
new libudev-dev 252.39-1
new libwayland-dev 1.21.0-1
$listed of the list" "$(print_changes)"
expect_equal "a GPU: no backports" 'Suites: bookworm Components: contrib' "$(print_sources)"

start_machine bookworm
echo "deb file:$archive bookworm-backports main" >>"$machine/apt/sources.list"
fake_apt apt-get update >/dev/null 2>&1
{
    printf '%s 2.4.123-1~bpo12+1\n' libdrm2 libdrm-common libdrm-amdgpu1 libdrm-intel1 libdrm-nouveau2 libdrm-radeon1
    printf '%s 25.0.7-2~bpo12+1\n' libgbm1 libgl1-mesa-dri mesa-vulkan-drivers
    echo libwayland-client0 1.23.0-1~bpo12+1
} | change_fakes
gpu
set_up || expect_equal "a GPU with drivers from backports: status" 0 "$(cat "$folder/output")"
expect_equal "a GPU with drivers from backports: what is built with them goes with them" "new libc6-dev 2.36-9+deb12u13
new libdrm-dev 2.4.123-1~bpo12+1
new libgbm-dev 25.0.7-2~bpo12+1
new libsdl2-dev 2.26.5-1
new libudev-dev 252.39-1
new libwayland-dev 1.23.0-1~bpo12+1
$listed of the list" "$(print_changes)"

start_machine bookworm
: >"$machine/dev/nvidia0"
set_up || expect_equal "NVIDIA: status" 0 1
expect_equal "NVIDIA without a Vulkan driver: none is installed" '' "$(has_fake mesa-vulkan-drivers)"
expect_says "NVIDIA without a Vulkan driver" 'no Vulkan driver.*|nvidia-driver'

start_machine trixie
set_up || expect_equal "Debian 13: status" 0 1
expect_equal "Debian 13: its own Mesa, nothing upgraded" '25.0.7-2 0' "$(has_fake mesa-vulkan-drivers) $(print_changes | grep -c '^upgrade')"
expect_equal "Debian 13: sources" 'Suites: trixie Components: contrib' "$(print_sources)"

rm -rf "${archive:?}/hidden"
mkdir "$archive/hidden" && mv "$archive/dists/bookworm-backports" "$archive/hidden/"
start_machine bookworm
set_up || expect_equal "a mirror without backports: status" 0 "$(cat "$folder/output")"
expect_equal "a mirror without backports: the release's Mesa, no broken source" '22.3.6-1+deb12u1 Suites: bookworm Components: contrib' \
    "$(has_fake mesa-vulkan-drivers) $(print_sources)"
expect_says "a mirror without backports" 'will trace in compute shaders'
: >"$machine/calls"
set_up
expect_equal "a mirror without backports: it is not asked for again" '' "$(cat "$machine/calls")"
mv "$archive/hidden/bookworm-backports" "$archive/dists/"

# Machines that are behind, and what may be done about it.
start_machine bookworm
install_fake libc6 2.36-9+deb12u1
set_up || expect_equal "an older build of the C library: status" 0 "$(cat "$folder/output")"
expect_equal "an older build of the C library: its own newer one" 'upgrade libc6 2.36-9+deb12u13' "$(print_changes | sed -n 's/^\(upgrade [^ ]* [^ ]*\).*/\1/p')"

start_machine bookworm libgl1-mesa-dri=22.3.6-1 libgbm1=22.3.6-1
set_up || expect_equal "Mesa without its release's last fix: status" 0 "$(cat "$folder/output")"
expect_equal "Mesa without its release's last fix: gets it" 'upgrade libgbm1 22.3.6-1+deb12u1' "$(print_changes | sed -n 's/^\(upgrade lib[^ ]* 22[^ ]*\).*/\1/p')"
start_machine bookworm libgl1-mesa-dri=22.3.6-1 libgbm1=22.3.6-1
gpu
set_up && expect_equal "a GPU's Mesa without its last fix: refused" 1 0
start_machine bookworm libgl1-mesa-dri=22.3.5-1 libgbm1=22.3.5-1
set_up && expect_equal "an older Mesa: refused" 1 0

start_machine bookworm
install_fake libudev1 252.1-1
install_fake udev 252.1-1
cp "$machine/dpkg/status" "$folder/status"
set_up && expect_equal "an older udev: refused" 1 0
expect_says "an older udev" 'upgrade udev 252\.1-1 to 252\.39-1'
expect_says "an older udev" 'Bring it up to date yourself'
expect_equal "an older udev: untouched" '' "$(cat "$machine/calls" 2>/dev/null; print_sources; diff "$folder/status" "$machine/dpkg/status")"

add_package trixie main old-init 1 '' 'Conflicts: cmake'
finish_suite trixie 13.2 Debian
start_machine trixie old-init
set_up && expect_equal "a removal: refused" 1 0
expect_says "a removal" 'remove old-init 1'

# What only the tests need.
start_machine bookworm
needed_for=play
set_up || expect_equal "to play: status" 0 1
expect_equal "to play: no stand-in for GPUs" '' "$(has_fake mesa-drm-shim)"
needed_for=test
set_up || expect_equal "to test behind that: status" 0 "$(cat "$folder/output")"
expect_equal "to test behind that: nothing but the rest of the list and the stand-in" 'mesa-drm-shim' \
    "$(print_changes | sed -n 's/^new \([^ ]*\).*/\1/p' | paste -sd' ')"
: >"$machine/calls"
set_up
expect_equal "to test behind that: a second time" '' "$(cat "$machine/calls")"

# Nobody there to ask.
start_machine bookworm
answer_yes=no
set_up && expect_equal "no terminal: status" 1 0
expect_says "no terminal: what" 'mesa-vulkan-drivers 25\.0\.7-2~bpo12\+1'
expect_says "no terminal: what" 'Suites: bookworm-backports'
expect_says "no terminal: how" '--setup-only --yes'
expect_equal "no terminal: nothing was touched" '' "$(cat "$machine/calls" 2>/dev/null; print_sources; ls "$machine/record")"
CI=false set_up && expect_equal "CI=false is no yes" 1 0
CI=true set_up || expect_equal "CI=true is a yes" 0 1

# No network and no lists: no answer, but clear words.
start_machine bookworm
rm -rf "$machine/lists"/*
echo "deb file:$folder/nowhere bookworm main" >"$machine/apt/sources.list"
set_up && expect_equal "no package lists: status" 1 0
expect_says "no package lists" 'apt cannot install what is missing'

((failures == 0)) && echo "set-up of machines: all as it should be"
((failures == 0))
