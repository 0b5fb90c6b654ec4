# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # root, log_dir: see common.sh; apt_dir: apt_sources.sh
# What apt would do, found out beforehand: with a copy of the machine's sources and lists in build/apt, which an ordinary
# user may add to and renew as well. Nothing of the machine is touched.

apt_lists=/var/lib/apt/lists
dpkg_dir=/var/lib/dpkg
apt_extra_settings= # more lines of apt's configuration; the tests' own
plan_dir=$root/build/apt

# The packages that may be drawn from backports: Mesa's Vulkan drivers, and libdrm, all of whose parts have to be of one version.
mesa_packages=(mesa-vulkan-drivers libdrm2 libdrm-common libdrm-amdgpu1 libdrm-dev libdrm-intel1 libdrm-nouveau2 libdrm-radeon1)

# A development package wants its library in exactly its own version. Where the library is of another version than the
# release's (drivers from backports), so have to be these: the library first, then what goes with it.
library_companions=(
    "libdrm2 libdrm-dev libdrm-amdgpu1 libdrm-intel1 libdrm-nouveau2 libdrm-radeon1"
    "libgbm1 libgbm-dev"
    "libwayland-client0 libwayland-dev libwayland-bin libwayland-cursor0 libwayland-egl1 libwayland-server0"
    "libudev1 libudev-dev"
    "libvulkan1 libvulkan-dev"
    "libsdl2-2.0-0 libsdl2-dev"
)

# A set-up must not exchange these under a running system, not even for a newer build of the same release.
is_guarded() {
    case ${1%%:*} in
    systemd | systemd-* | udev | init | dbus | dbus-* | libpam-* | libnss-* | linux-image-* | grub-* | xserver-xorg* | xwayland) ;;
    libwayland-* | libgl1-mesa-dri | libglx-mesa0 | libegl-mesa0 | libglapi-mesa | mesa-* | libgbm1 | libdrm* | *nvidia*) ;;
    *) return 1 ;;
    esac
}

installed_version() { dpkg-query --admindir="$dpkg_dir" -W -f '${db:Status-Status} ${Version}' "$1" 2>/dev/null | sed -n 's/^installed //p'; }

# --- apt on the copies --------------------------------------------------------------------------------------------

# copy_apt_state STANZAS: the machine's sources and lists, with STANZAS as one more file.
copy_apt_state() {
    local file
    rm -rf "$plan_dir"
    mkdir -p "$plan_dir/sources" "$plan_dir/lists" "$plan_dir/cache" || die "cannot write to $plan_dir"
    for file in "$apt_dir"/sources.list.d/*.list "$apt_dir"/sources.list.d/*.sources; do
        [[ -r $file ]] && cp "$file" "$plan_dir/sources/"
    done
    [[ -z $1 ]] || printf '\n%s\n' "$1" >>"$plan_dir/sources/${own_sources_file##*/}"
    # The files (links to archives on the same machine), not what lies in partial/; with their times, by which apt sees what is new.
    find "$apt_lists" -maxdepth 1 \( -type f -o -type l \) ! -name lock -readable -exec cp --preserve=timestamps -t "$plan_dir/lists" {} + 2>/dev/null
    cat >"$plan_dir/apt.conf" <<CONF
Dir::Etc::SourceList "$apt_dir/sources.list";
Dir::Etc::SourceParts "$plan_dir/sources";
Dir::State::Lists "$plan_dir/lists";
Dir::State::status "$dpkg_dir/status";
Dir::Cache "$plan_dir/cache";
Debug::NoLocking "true";
#clear APT::Update::Pre-Invoke;
#clear APT::Update::Post-Invoke;
#clear APT::Update::Post-Invoke-Success;
$apt_extra_settings
CONF
}

plan_apt() { LC_ALL=C "$1" -c "$plan_dir/apt.conf" "${@:2}"; }
plan_candidate() { plan_apt apt-cache policy "$1" 2>/dev/null | sed -n 's/^ *Candidate: //p' | grep -vxF '(none)'; }
# Not by `grep -q`, which ends before apt-cache has written all.
plan_has_version() { plan_apt apt-cache madison "$1" 2>/dev/null | awk -F' *[|] *' -v version="$2" '$2 == version { found = 1 } END { exit !found }'; }
plan_has_suite() { plan_apt apt-cache madison "$1" 2>/dev/null | awk -v suite=" $2/" 'index($0, suite) { found = 1 } END { exit !found }'; }

# --- what to ask apt for ------------------------------------------------------------------------------------------

# Libraries that are not of the release's version: NAME=VERSION for what has to follow them.
print_companions() {
    local row library version name
    local -a names
    for row in "${library_companions[@]}"; do
        read -ra names <<<"$row"
        library=${names[0]}
        version=$(installed_version "$library")
        [[ -n $version && $version != "$(plan_candidate "${names[1]}")" ]] || continue
        for name in "${names[@]:1}"; do
            [[ -z $(installed_version "$name") ]] && plan_has_version "$name" "$version" && echo "$name=$version"
        done
    done
}

# Mesa's drivers in the form that apt-get install takes: by name where the release's are new enough, else from backports, each by
# its name: naming the suite (-t) would draw in systemd, Wayland and whatever else is newer there.
print_mesa_arguments() {
    local candidate suite name
    candidate=$(plan_candidate mesa-vulkan-drivers)
    suite=$(release_codename)-backports
    if [[ -n $candidate ]] && dpkg --compare-versions "$candidate" ge "$raytracing_mesa"; then
        echo mesa-vulkan-drivers
    elif plan_has_suite mesa-vulkan-drivers "$suite"; then
        for name in "${mesa_packages[@]}"; do
            plan_has_suite "$name" "$suite" && echo "$name/$suite"
        done
    else
        echo mesa-vulkan-drivers
    fi
}

# The stand-in for GPUs, which needs nothing else; from where Mesa's drivers are.
print_shim_argument() {
    local suite
    suite=$(release_codename)-backports
    if plan_has_suite mesa-drm-shim "$suite"; then
        echo "mesa-drm-shim/$suite"
    elif [[ -n $(plan_candidate mesa-drm-shim) ]]; then
        echo mesa-drm-shim
    fi
}

# --- the simulated run --------------------------------------------------------------------------------------------

# Reads `apt-get -s` and prints "new NAME VERSION", "upgrade NAME VERSION OLD ORIGIN" and "remove NAME VERSION".
read_simulation() {
    awk '
        $1 == "Remv" || $1 == "Purg" { version = $3; gsub(/[][]/, "", version); print "remove", $2, version }
        $1 == "Inst" {
            old = ""; rest = $0
            if ($3 ~ /^\[/) { old = $3; gsub(/[][]/, "", old) }
            sub(/^[^(]*\(/, "", rest); sub(/\).*/, "", rest)
            version = rest; sub(/ .*/, "", version); sub(/^[^ ]* /, "", rest); sub(/ \[.*/, "", rest)
            if (old == "") print "new", $2, version; else print "upgrade", $2, version, old, rest
        }' | sort
}

# plan_installation WITH_MESA WITH_SHIM PACKAGE...: sets plan_sources (stanzas), plan_arguments (of apt-get install) and plan_changes (lines of
# read_simulation). Ends the script where apt cannot do it.
plan_sources='' plan_changes='' plan_download=''
declare -a plan_arguments=()
plan_installation() {
    local with_mesa=$1 with_shim=$2 with_backports=no with_contrib=no release
    shift 2
    plan_sources=
    if is_debian; then
        release=$(release_number)
        [[ $with_mesa$with_shim == *yes* && -n $release && ${release%%.*} -lt 13 ]] && with_backports=yes
        [[ " $* " == *" yamagi-quake2"* ]] && with_contrib=yes
        plan_sources=$(missing_sources "$with_backports" "$with_contrib")
        check_own_key "$plan_sources"
    fi
    copy_apt_state "$plan_sources"
    run_step apt-plan "Looking at what apt would install (nothing is changed yet)" plan_apt apt-get -q -o Acquire::Retries=3 update \
        || warn "apt could not read all package lists ($log_dir/apt-plan.log); continuing with those that are there"
    mapfile -t plan_arguments < <(
        [[ $with_mesa == no ]] || print_mesa_arguments
        [[ $with_shim == no ]] || print_shim_argument
        (($# == 0)) || printf '%s\n' "$@"
        [[ " $* " != *" libsdl2-dev "* && " $* " != *" libvulkan-dev "* ]] || print_companions)
    if [[ $with_backports == yes && " ${plan_arguments[*]} " != *" mesa-"*/* ]]; then
        [[ $with_mesa == no ]] || warn "no newer Mesa in $(release_codename)-backports: the release's Mesa $(plan_candidate mesa-vulkan-drivers) has no ray tracing; ref_vkpt will trace in compute shaders"
        plan_sources=$(missing_sources no "$with_contrib")
    fi
    plan_changes=
    ((${#plan_arguments[@]} == 0)) || simulate_plan
    rm -rf "$plan_dir"
}

simulate_plan() {
    local output
    if ! output=$(plan_apt apt-get -s install --no-install-recommends "${plan_arguments[@]}" 2>&1); then
        printf '%s\n' "$output" | grep -vE '^(Reading|Building|NOTE|Inst|Conf| +(apt-get|Keep|so don))' >&2
        die "apt cannot install what is missing: ${plan_arguments[*]}
What apt said is above. Without package lists or a network: connect, run apt-get update, start again. With packages of another
release or held back: bring the system into order first (apt-get install -f, apt-mark showhold)."
    fi
    plan_changes=$(read_simulation <<<"$output")
    plan_download=$(plan_apt apt-get -qq --print-uris install --no-install-recommends "${plan_arguments[@]}" 2>/dev/null \
        | awk '{ sum += $3 } END { printf "%.0f MB", sum / 1e6 }')
}

# Mesa's OpenGL libraries, where no GPU uses them, may get their release's own fixes: another Debian revision of the same version.
# libsdl2-dev asks for that on a machine that is behind by one update of Mesa.
is_fix_of_unused_mesa() {
    case ${1%%:*} in
    libgl1-mesa-dri | libglx-mesa0 | libegl-mesa0 | libglapi-mesa | libgbm1) ;;
    *) return 1 ;;
    esac
    [[ ${2%-*} == "${3%-*}" ]] && ! has_gpu
}

# is_wanted_upgrade NAME VERSION OLD ORIGIN: Mesa's packages from backports when asked for so, and newer builds of this very release
# that a development package demands of its library.
is_wanted_upgrade() {
    local argument release
    for argument in "${plan_arguments[@]}"; do
        [[ ${1%%:*} == "${argument%%[/=]*}" ]] && return 0
    done
    is_guarded "$1" && ! is_fix_of_unused_mesa "$1" "$2" "$3" && return 1
    release=$(release_number)
    [[ -n $release && $4 =~ (^|, ?)Debian(-Security)?:${release%%.*}[./-] ]]
}

# Ends the script where the plan would touch what the game does not need.
check_plan() {
    local kind name version old origin refused=
    while read -r kind name version old origin; do
        case $kind in
        remove) refused+="   remove $name $version"$'\n' ;;
        upgrade) is_wanted_upgrade "$name" "$version" "$old" "$origin" || refused+="   upgrade $name $old to $version"$'\n' ;;
        esac
    done <<<"$plan_changes"
    [[ -z $refused ]] && return 0
    printf 'With the missing packages apt would also\n%s' "$refused" >&2
    die "nothing was installed: the set-up does not change the system. Bring it up to date yourself (apt-get update, apt-get upgrade), \
then start again; or install what is missing by hand (docs/building.md)."
}

# --- in words -----------------------------------------------------------------------------------------------------

# Names with versions, several a line.
print_names() {
    awk -v kind="$1" '
        $1 == kind {
            word = $2 " " (kind == "upgrade" ? $4 " to " $3 : $3)
            if (line != "" && length(line) + length(word) > 110) { print "   " line ","; line = "" }
            line = line (line == "" ? "" : ", ") word
        }
        END { if (line != "") print "   " line }' <<<"$plan_changes"
}
count_changes() { grep -c "^$1 " <<<"$plan_changes"; }

print_plan() {
    local line
    if [[ -n $plan_sources ]]; then
        say "apt needs these sources as well ($own_sources_file):"
        while IFS= read -r line; do note "$line"; done <<<"$plan_sources"
        say
    fi
    if (($(count_changes upgrade))); then
        say "These packages would be upgraded:"
        print_names upgrade
    fi
    say "These $(count_changes new) packages would be installed ($plan_download to fetch):"
    print_names new
}
