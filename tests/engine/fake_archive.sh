# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # folder: the sourcing test's
# A small archive of packages that exist by name only, and machines that have some of them: apt's own decisions, without a network
# and without being root. Versions and dependencies are those of Debian where a test's result hangs on them.

archive=$folder/archive
machine=$folder/machine
architecture=$(dpkg --print-architecture)

# add_package SUITE COMPONENT NAME VERSION [DEPENDS [MORE-FIELDS]]
add_package() {
    local packages=$archive/dists/$1/$2/binary-$architecture/Packages
    mkdir -p "${packages%/*}"
    {
        printf 'Package: %s\nVersion: %s\nArchitecture: %s\nMaintainer: nobody\nDescription: a name\n' "$3" "$4" "$architecture"
        printf 'Filename: pool/%s_%s.deb\nSize: 1000000\nSHA256: %064d\n' "$3" "$4" 0
        [[ -z ${5:-} ]] || printf 'Depends: %s\n' "$5"
        [[ -z ${6:-} ]] || printf '%s\n' "$6"
        printf '\n'
    } >>"$packages"
}

# finish_suite SUITE VERSION LABEL [MORE-FIELDS]: the file by which apt knows a suite.
finish_suite() {
    local component components=''
    for component in "$archive/dists/$1"/*/; do
        component=${component%/}
        components+=" ${component##*/}"
    done
    {
        printf 'Origin: %s\nLabel: %s\nSuite: %s\nCodename: %s\nVersion: %s\nArchitectures: %s\nComponents:%s\n' \
            "$3" "$3" "$1" "$1" "$2" "$architecture" "$components"
        printf 'Date: Sat, 01 Jan 2022 00:00:00 UTC\n'
        [[ -z ${4:-} ]] || printf '%s\n' "$4"
        printf 'SHA256:\n'
        (cd "$archive/dists/$1" && for component in */; do
            printf ' %s %s %s\n' "$(sha256sum <"${component}binary-$architecture/Packages" | cut -d' ' -f1)" \
                "$(stat -c %s "${component}binary-$architecture/Packages")" "${component}binary-$architecture/Packages"
        done)
    } >"$archive/dists/$1/Release"
}

# print_stanza NAME VERSION: from whichever suite has it.
print_stanza() {
    cat "$archive"/dists/*/*/binary-*/Packages \
        | awk -v RS='' -v name="$1" -v version="$2" '$0 ~ "^Package: " name "\n" && index($0, "\nVersion: " version "\n") && !done { print $0; done = 1 }' \
        | grep -vE '^(Filename|Size|SHA256):'
}

# install_fake NAME VERSION: the machine has it from now on, in place of another version.
install_fake() {
    remove_fake "$1"
    print_stanza "$1" "$2" | sed '1a Status: install ok installed' >>"$machine/dpkg/status"
    echo >>"$machine/dpkg/status"
    grep -q "^Package: $1$" "$machine/dpkg/status" || echo "no $1 $2 in the archive" >&2
}
remove_fake() {
    awk -v RS='' -v ORS='\n\n' -v name="$1" '$0 !~ "^Package: " name "\n"' "$machine/dpkg/status" >"$machine/status.new"
    mv "$machine/status.new" "$machine/dpkg/status"
}
has_fake() { dpkg-query --admindir="$machine/dpkg" -W -f '${Version}' "$1" 2>/dev/null; }

# new_machine SUITE: a machine with one source, package lists and no packages.
new_machine() {
    rm -rf "$machine"
    mkdir -p "$machine"/{apt/sources.list.d,apt/preferences.d,dpkg/{info,updates},lists,cache,dev/dri,proc,vulkan,record}
    : >"$machine/dpkg/status"
    : >"$machine/extended_states"
    echo "deb file:$archive $1 main" >"$machine/apt/sources.list"
    cat >"$machine/apt.conf" <<CONF
Dir::Etc::SourceList "$machine/apt/sources.list";
Dir::Etc::SourceParts "$machine/apt/sources.list.d";
Dir::State::Lists "$machine/lists";
Dir::Cache "$machine/cache";
$(print_machine_settings)
CONF
    fake_apt apt-get update >/dev/null 2>&1
}
# What the scripts' own copies need to be told, too.
print_machine_settings() {
    cat <<CONF
Dir::State::status "$machine/dpkg/status";
Dir::State::extended_states "$machine/extended_states";
Dir::Etc::Preferences "$machine/apt/preferences";
Dir::Etc::PreferencesParts "$machine/apt/preferences.d";
APT::Architectures { "$architecture"; };
APT::Sandbox::User "";
Acquire::AllowInsecureRepositories "true";
APT::Get::AllowUnauthenticated "true";
Debug::NoLocking "true";
CONF
}
fake_apt() { LC_ALL=C "$1" -q -c "$machine/apt.conf" "${@:2}"; }

# In place of the real `apt-get update` and `install` of the scripts: what apt would do is done to the list of what is installed.
play_apt() {
    local kind name version
    echo "$*" >>"$machine/calls"
    if [[ $1 == update ]]; then
        fake_apt apt-get update
        return
    fi
    fake_apt apt-get -s "$@" >"$machine/simulation" || return 1
    while read -r kind name version _; do
        if [[ $kind == remove ]]; then remove_fake "$name"; else install_fake "$name" "$version"; fi
    done < <(read_simulation <"$machine/simulation")
}
