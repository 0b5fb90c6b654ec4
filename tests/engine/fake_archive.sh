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
    [[ -d ${packages%/*} ]] || mkdir -p "${packages%/*}"
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
    rm -rf "$folder/known_lists"
}

# change_fakes: the machine has these from now on, in place of other versions: lines "NAME VERSION", or "NAME" for what it loses. All in
# one go: a process for each of hundreds of packages takes minutes.
change_fakes() {
    awk -v ORS='\n\n' '
        phase == "changes" { wanted[$1] = $2; next }
        phase == "status" { if (!($2 in wanted)) print; next }
        wanted[$2] != "" && !($2 in found) && index($0, "\nVersion: " wanted[$2] "\n") {
            found[$2] = 1
            gsub(/\n(Filename|Size|SHA256):[^\n]*/, "")
            sub(/\n/, "\nStatus: install ok installed\n")
            print
        }
        END {
            for (name in wanted)
                if (wanted[name] != "" && !(name in found)) print "no " name " " wanted[name] " in the archive" >"/dev/stderr"
        }' phase=changes - RS= phase=status "$machine/dpkg/status" phase=archive "$archive"/dists/*/*/binary-*/Packages >"$machine/status.new"
    mv "$machine/status.new" "$machine/dpkg/status"
}
install_fake() { change_fakes <<<"$1 $2"; } # NAME VERSION
has_fake() { dpkg-query --admindir="$machine/dpkg" -W -f '${Version}' "$1" 2>/dev/null; }

# new_machine SUITE: a machine with one source, package lists and no packages. Machines begin with the same lists until the archive changes.
new_machine() {
    local known=$folder/known_lists/$1
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
    if [[ ! -d $known ]]; then
        fake_apt apt-get update >/dev/null 2>&1
        mkdir -p "$folder/known_lists" && cp -a "$machine/lists" "$known"
    else
        cp -a "$known/." "$machine/lists/"
    fi
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
#clear APT::Update::Pre-Invoke;
#clear APT::Update::Post-Invoke;
#clear APT::Update::Post-Invoke-Success;
CONF
}
fake_apt() { LC_ALL=C "$1" -q -c "$machine/apt.conf" "${@:2}"; }

# In place of the real `apt-get update` and `install` of the scripts: what apt would do is done to the list of what is installed.
play_apt() {
    echo "$*" >>"$machine/calls"
    if [[ $1 == update ]]; then
        fake_apt apt-get update
        return
    fi
    fake_apt apt-get -s "$@" >"$machine/simulation" || return 1
    read_simulation <"$machine/simulation" | awk '{ print $2, $1 == "remove" ? "" : $3 }' | change_fakes
}
