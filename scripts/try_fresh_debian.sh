#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The README's two commands, and the package, on a bare Debian made for the purpose. See --help.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"

print_help() {
    cat <<'HELP'
Usage: scripts/try_fresh_debian.sh [OPTION]... SUITE

Makes a bare Debian of SUITE (bookworm or trixie) with debootstrap, clones what is committed here into it, and tries there, in
this order:

  refuse    ./play and ./test without a terminal and without --yes: they end with 1, say what to do, and install nothing
  root      ./test and ./play as root, cloned into /root, without a terminal
  user      ./play and ./test as an ordinary user, cloned into that user's home
  package   scripts/make_package.sh; in a second bare system the package is installed, played by an ordinary user, and removed
  uninstall ./play --uninstall: the packages are those of before

  --only PART,...     only these parts; each needs what the parts before it have installed
  --tests REGEX       of ./test, only the suites whose name matches (all)
  --cache DIR         a folder for ccache that the systems share, so that repeated builds take minutes
  --folder DIR        where the systems are made (build/fresh/SUITE), some 12 GB; existing ones are used again
  --mirror URL        Debian's mirror (http://deb.debian.org/debian)
  -h, --help          this text

Needs root and the package debootstrap; nothing outside DIR is changed. The output of the commands is in DIR/log.
Exit status: 0 everything was as expected, 1 something was not, 2 wrong use.
HELP
}

suite='' only=refuse,root,user,package,uninstall tests='' cache='' folder='' mirror=http://deb.debian.org/debian
while (($#)); do
    case $1 in
    -h | --help) print_help; exit 0 ;;
    --only) only=${2:-}; shift ;;
    --tests) tests=${2:-}; shift ;;
    --cache) cache=${2:-}; shift ;;
    --folder) folder=${2:-}; shift ;;
    --mirror) mirror=${2:-}; shift ;;
    -*) die_usage "unknown option '$1'" ;;
    *) suite=$1 ;;
    esac
    shift
done
case $suite in
bookworm | trixie) ;;
'') die_usage "which suite: bookworm or trixie?" ;;
*) die_usage "the suites are bookworm and trixie, not '$suite'" ;;
esac
for part in ${only//,/ }; do
    case $part in
    refuse | root | user | package | uninstall) ;;
    *) die_usage "there is no part '$part'" ;;
    esac
done
is_root || die "debootstrap and chroot need root: sudo scripts/try_fresh_debian.sh $suite"
has debootstrap || die "debootstrap is not installed: apt install debootstrap"
folder=${folder:-$root/build/fresh/$suite}
mkdir -p "$folder/log" || die "cannot make $folder"
log_dir=$folder/log
# Both users of the systems write there.
[[ -z $cache ]] || { mkdir -p "$cache" && chmod 1777 "$cache" && cache=$(realpath "$cache"); } || die "cannot make $cache"
failures=0 checks=0

# make_system NAME: a bare Debian with what a clone needs, and an ordinary user.
make_system() {
    local system=$folder/$1
    [[ -e $system/made ]] && return 0
    run_step "debootstrap-$1" "Making $system" \
        debootstrap --variant=minbase --include="ca-certificates,git${cache:+,ccache}" "$suite" "$system" "$mirror" || die "debootstrap failed"
    cp /etc/resolv.conf "$system/etc/resolv.conf"
    inside "$1" root 'useradd --create-home --shell /bin/bash player && apt-get update' >"$log_dir/made-$1" 2>&1 \
        || die "the new system does not work; see $log_dir/made-$1"
    touch "$system/made"
}

# inside SYSTEM USER COMMAND: run by the shell of that user at home, with nothing of our environment and no terminal.
inside() {
    local home=/root
    local -a compiler=()
    [[ $2 == root ]] || home=/home/$2
    # Relative paths, so that what one user has compiled serves the other.
    [[ -z $cache ]] || compiler=(CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_DIR=/ccache
        CCACHE_UMASK=000 CCACHE_BASEDIR="$home" CCACHE_NOHASHDIR=1)
    # shellcheck disable=SC2016  # expanded within
    unshare --mount --propagation private bash -c '
        system=$1 user=$2 home=$3 command=$4 cache=$5
        shift 5
        mount -t proc proc "$system/proc" && mount -t tmpfs -o mode=1777 tmpfs "$system/tmp" \
            && mount --rbind /dev "$system/dev" && mount -t tmpfs -o mode=1777 tmpfs "$system/dev/shm" \
            && { [ -z "$cache" ] || { mkdir -p "$system/ccache" && mount --bind "$cache" "$system/ccache"; }; } || exit 125
        exec chroot --userspec="$user:$user" "$system" /usr/bin/env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin:/usr/games \
            HOME="$home" USER="$user" LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@" bash -c "cd && $command"' \
        bash "$folder/$1" "$2" "$home" "$3" "$cache" ${compiler[@]+"${compiler[@]}"} </dev/null
}

# check NAME STATUS PATTERN SYSTEM USER COMMAND: the command ends with STATUS and says PATTERN, if that is not empty.
check() {
    local name=$1 status=$2 pattern=$3 got=0 start=$SECONDS
    inside "$4" "$5" "$6" >"$log_dir/$name" 2>&1 || got=$?
    checks=$((checks + 1))
    if [[ $got -ne $status ]]; then
        warn "$name: ended with $got, not $status; see $log_dir/$name"
    elif [[ -n $pattern ]] && ! grep -qE -- "$pattern" "$log_dir/$name"; then
        warn "$name: did not say '$pattern'; see $log_dir/$name"
    else
        note "$name: as it should be ($((SECONDS - start)) s)"
        return 0
    fi
    failures=$((failures + 1))
}

wanted() { [[ ,$only, == *,$1,* ]]; }
list_packages() { inside "$1" root 'dpkg-query -W -f "\${Package} \${Version}\n"'; }

# clone USER: what is committed here, in that user's home.
clone() {
    local home=root
    [[ $1 == root ]] || home=home/$1
    local copy=$folder/build/$home/ref_vkpt
    if [[ -d $copy ]]; then # of an earlier run
        git -c safe.directory='*' -C "$copy" pull --quiet --ff-only "$root" HEAD || die "cannot bring $copy up to date"
    else
        git clone --quiet "$root" "$copy" || die "cannot clone $root"
    fi
    chown -R --reference="$folder/build/$home" "$copy"
}

test_command="./test${tests:+ -- -R '$tests'}"

try_refusals() {
    local command
    list_packages build >"$log_dir/packages-before"
    for command in play test; do
        check "refuse-$command" 1 'nothing was installed: there is no terminal .*--yes' build root "cd ref_vkpt && ./$command"
    done
    list_packages build | diff "$log_dir/packages-before" - >"$log_dir/refuse-packages" || {
        warn "packages have changed, though nobody agreed; see $log_dir/refuse-packages"
        failures=$((failures + 1))
    }
}

try_as_root() {
    check root-play 0 'contact_sheet.png' build root 'cd ref_vkpt && VKPT_PICTURES=6 ./play --yes --size 320x180'
    check root-test 0 '^[1-9][0-9]* passed, 0 failed' build root "cd ref_vkpt && ${test_command/.\/test/.\/test --yes}"
}

try_as_user() {
    check user-play 0 'contact_sheet.png' build player 'cd ref_vkpt && VKPT_PICTURES=6 ./play --size 320x180'
    check user-test 0 '^[1-9][0-9]* passed, 0 failed' build player "cd ref_vkpt && $test_command"
}

# The engine is in contrib; on Debian 12 the driver that traces rays is in backports.
add_sources() {
    local lines="deb $mirror $suite contrib"
    [[ $suite != bookworm ]] || lines+=$'\n'"deb $mirror bookworm-backports main"
    printf '%s\n' "$lines" >"$folder/plain/etc/apt/sources.list.d/more.list"
}

try_package() {
    local driver=mesa-vulkan-drivers
    [[ $suite != bookworm ]] || driver+=/bookworm-backports
    check package-make 0 'out/packages/ref-vkpt_' build root \
        'apt-get install -y --no-install-recommends dpkg-dev lintian && cd ref_vkpt && scripts/make_package.sh'
    make_system plain
    add_sources
    rm -f "$folder"/plain/root/*.deb
    cp "$folder"/build/root/ref_vkpt/out/packages/*.deb "$folder/plain/root/" || die "there is no package"
    list_packages plain >"$log_dir/plain-before"
    check package-install 0 'Setting up ref-vkpt' plain root \
        "apt-get update && apt-get install -y --no-install-recommends $driver xvfb xauth ./ref-vkpt_*.deb"
    check package-play 0 'vkpt1' plain player \
        'xvfb-run -a vkpt-quake2 +set vid_fullscreen 0 +set r_mode -1 +set r_customwidth 320 +set r_customheight 180 +set s_initsound 0 +set timedemo 1 +set nextdemo quit +demomap vkpt1.dm2'
    check package-render 0 '' plain player 'vkpt render maps/vkpt1.bsp --size 160x90 --frames 2 -o picture.png && test -s picture.png'
    check package-remove 0 'Removing ref-vkpt' plain root \
        'apt-get remove -y --purge ref-vkpt && ! find /usr -iname "*vkpt*" -not -path "/usr/share/doc/*" | grep . '
}

try_uninstall() {
    # Those that package-make has installed.
    inside build root 'apt-get purge -y --autoremove dpkg-dev lintian' >"$log_dir/uninstall-tools" 2>&1
    check uninstall 0 '' build root 'cd ref_vkpt && ./play --uninstall --yes'
    list_packages build | diff "$log_dir/packages-before" - >"$log_dir/uninstall-packages" \
        || note "packages that differ from before: $(grep -c '^[<>]' "$log_dir/uninstall-packages") ($log_dir/uninstall-packages)"
}

say "-- Debian $suite in $folder"
make_system build
clone root
wanted refuse && try_refusals
wanted root && try_as_root
if wanted user; then
    clone player
    try_as_user
fi
wanted package && try_package
wanted uninstall && try_uninstall
say "$checks checks, $failures failed"
((failures == 0))
