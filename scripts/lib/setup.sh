# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # root: see common.sh
# What is missing on this machine, and its installation with apt. Nothing here touches a machine that has everything.

raytracing_mesa=24.1 # the first Mesa whose CPU driver has ray queries
apt_dir=${VKPT_APT_DIR:-/etc/apt} # another folder in the tests
own_sources_file=$apt_dir/sources.list.d/ref-vkpt.sources
debian_keyring=/usr/share/keyrings/debian-archive-keyring.gpg

read_package_list() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$root/scripts/packages.txt"; }

# The listed packages that are not installed, one a line.
find_missing_packages() {
    local -a wanted
    mapfile -t wanted < <(read_package_list)
    comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) \
        <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^installed //p' | sort -u)
}

installed_version() { dpkg-query -W -f '${db:Status-Status} ${Version}' "$1" 2>/dev/null | sed -n 's/^installed //p'; }
candidate_version() { LC_ALL=C apt-cache policy "$1" 2>/dev/null | sed -n 's/^ *Candidate: //p' | grep -vxF '(none)'; }

# True where a GPU (not the CPU driver) traces rays already: then the machine's Vulkan driver is none of our business.
has_raytracing_gpu() {
    [[ -e /proc/driver/nvidia/version || -e /dev/nvidia0 ]] && return 0
    has vulkaninfo || return 1
    vulkaninfo 2>/dev/null | awk '
        /^GPU[0-9]+:/ { gpu = 1 }
        /deviceType *=/ { gpu = ($0 !~ /_CPU/) }
        gpu && /VK_KHR_ray_(query|tracing_pipeline) / { found = 1 }
        END { exit !found }'
}

mesa_traces_rays() {
    local version
    version=$(installed_version mesa-vulkan-drivers)
    [[ -n $version ]] && dpkg --compare-versions "$version" ge "$raytracing_mesa"
}

# Written when no newer Mesa can be had, so that the question comes once.
no_mesa_stamp=$root/build/log/no-newer-mesa
needs_mesa() { ! mesa_traces_rays && [[ ! -e $no_mesa_stamp ]] && ! has_raytracing_gpu; }

# --- apt's sources ------------------------------------------------------------------------------------------------

# Every enabled binary source as "URI|SUITE|COMPONENTS|SIGNED-BY", from both file formats. A Signed-By that holds the key
# itself (many lines) is given as "inline".
list_apt_sources() {
    local file
    for file in "$apt_dir"/sources.list "$apt_dir"/sources.list.d/*.list; do
        [[ -r $file ]] || continue
        awk '
            $1 == "deb" {
                signed = ""; i = 2
                if ($2 ~ /^\[/) {
                    options = ""
                    for (; i <= NF; i++) { options = options " " $i; if ($i ~ /\]$/) { i++; break } }
                    gsub(/[\[\]]/, " ", options); n = split(options, option, " ")
                    for (k = 1; k <= n; k++) if (option[k] ~ /^signed-by=/) { signed = substr(option[k], 11) }
                }
                uri = $i; suite = $(i + 1); components = ""
                for (k = i + 2; k <= NF && $k !~ /^#/; k++) components = components " " $k
                print uri "|" suite "|" components " |" signed
            }' "$file"
    done
    for file in "$apt_dir"/sources.list.d/*.sources; do
        [[ -r $file ]] || continue
        awk '
            function flush_stanza(   u, s, i, j, nu, ns) {
                if (types ~ /(^| )deb( |$)/ && enabled !~ /^(no|false)$/) {
                    nu = split(uris, u, " "); ns = split(suites, s, " ")
                    for (i = 1; i <= nu; i++) for (j = 1; j <= ns; j++) print u[i] "|" s[j] "| " components " |" signed
                }
                types = uris = suites = components = signed = enabled = field = ""
            }
            /^#/ { next }
            /^[[:space:]]*$/ { flush_stanza(); next }
            /^[[:space:]]/ {
                if (field == "suites") suites = suites " " $0
                if (field == "uris") uris = uris " " $0
                if (field == "components") components = components " " $0
                if (field == "signed-by") signed = "inline"
                next
            }
            {
                field = tolower($0); sub(/:.*/, "", field); value = $0; sub(/^[^:]*:[[:space:]]*/, "", value)
                if (field == "types") types = value
                if (field == "uris") uris = value
                if (field == "suites") suites = value
                if (field == "components") components = value
                if (field == "signed-by") signed = value
                if (field == "enabled") enabled = tolower(value)
            }
            END { flush_stanza() }' "$file"
    done
}

release_codename() { sed -n 's/^VERSION_CODENAME=//p' /etc/os-release; }
is_debian() { grep -qx 'ID=debian' /etc/os-release; }

# The machine's own Debian archive as "URI|SIGNED-BY"; apt refuses a second entry for it with another Signed-By.
debian_archive() {
    local found
    found=$(list_apt_sources | awk -F'|' -v suite="$(release_codename)" '$2 == suite && $3 ~ / main / { print $1 "|" $4; exit }')
    echo "${found:-http://deb.debian.org/debian|$debian_keyring}"
}

has_source() { # SUITE COMPONENT
    list_apt_sources | awk -F'|' -v suite="$1" -v component=" $2 " \
        '$2 == suite && index($3, component) { found = 1 } END { exit !found }'
}

# The stanzas that this machine lacks, on stdout. WITH_BACKPORTS: yes or no.
missing_sources() {
    local with_backports=$1 codename archive uri signed
    codename=$(release_codename)
    archive=$(debian_archive)
    uri=${archive%%|*}
    signed=${archive#*|}
    emit() {
        printf 'Types: deb\nURIs: %s\nSuites: %s\nComponents: %s\n' "$uri" "$1" "$2"
        [[ -n $signed ]] && printf 'Signed-By: %s\n' "$signed"
        printf '\n'
    }
    has_source "$codename" contrib || emit "$codename" contrib
    [[ $with_backports == no ]] || has_source "$codename-backports" main || emit "$codename-backports" main
}

# --- installing ---------------------------------------------------------------------------------------------------

as_root() {
    if is_root; then
        "$@"
    elif is_interactive; then
        sudo -- "$@"
    else
        sudo -n -- "$@"
    fi
}

run_apt() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 -o Dpkg::Use-Pty=0 "$@"
}
update_lists() { run_step apt-update "$1" run_apt update; }
install_packages() { # NAME TITLE ARGUMENTS...
    local name=$1 title=$2
    shift 2
    run_step "$name" "$title" run_apt install -y --no-install-recommends "$@"
}

write_own_sources() {
    local text=$1
    if [[ $text == *'Signed-By: inline'* ]]; then
        die "the Debian entry in /etc/apt has its key inline; add the component contrib to it by hand, then start again"
    fi
    printf '# Written by ref_vkpt (scripts/lib/setup.sh); safe to remove after the set-up.\n%s\n' "$text" \
        | as_root tee "$own_sources_file" >/dev/null || die "cannot write $own_sources_file"
}

read_new_sources() {
    update_lists "Reading the new package lists" && return 0
    warn "apt cannot read all of the new sources; trying without backports"
    as_root rm -f "$own_sources_file"
    local stanzas
    stanzas=$(missing_sources no)
    [[ -z $stanzas ]] || write_own_sources "$stanzas"
    update_lists "Reading the new package lists" || die "apt cannot read $own_sources_file; it can be removed"
}

# Debian 12 with the machine's Mesa too old, unless the release's own one will do.
needs_backports() {
    is_debian || return 1
    needs_mesa || return 1
    local release_version
    release_version=$(candidate_version mesa-vulkan-drivers)
    [[ -n $release_version ]] && ! dpkg --compare-versions "$release_version" ge "$raytracing_mesa"
}

install_mesa() {
    local backports
    backports=$(release_codename)-backports
    if needs_backports; then
        # Backports' Mesa brings a newer libdrm, which the release's libsdl2-dev does not go with: both in one call, first.
        install_packages apt-mesa "Installing Mesa's Vulkan drivers with ray tracing from $backports" \
            -t "$backports" mesa-vulkan-drivers libsdl2-dev && return 0
    elif install_packages apt-mesa "Installing Mesa's Vulkan drivers" mesa-vulkan-drivers && mesa_traces_rays; then
        return 0
    fi
    warn "no Vulkan driver with hardware or emulated ray tracing could be installed; ref_vkpt will trace in compute shaders"
    install_packages apt-mesa "Installing the release's own Vulkan drivers" mesa-vulkan-drivers || return 1
    touch "$no_mesa_stamp"
}

check_can_install() {
    has apt-get || die "this system has no apt. Install the equivalents of: $(read_package_list | tr '\n' ' ')"
    is_root || has sudo || die "not root, and no sudo here. As root, run: ./${0##*/} --setup-only"
    if ! is_root && ! is_interactive; then
        sudo -n true 2>/dev/null || die "sudo asks for a password, which needs a terminal. As root, run: ./${0##*/} --setup-only"
    fi
}

# Installs what is missing. Quick (no apt, no network) where nothing is.
set_up_machine() {
    local -a missing
    local stanzas line mesa=no
    if ! has dpkg-query; then
        warn "not a Debian system: the packages are not checked (scripts/packages.txt lists them)"
        return 0
    fi
    mapfile -t missing < <(find_missing_packages)
    needs_mesa && mesa=yes
    ((${#missing[@]} == 0)) && [[ $mesa == no ]] && return 0

    say "ref_vkpt needs packages that are not installed:"
    note "${missing[*]}$([[ $mesa == yes ]] && echo ' mesa-vulkan-drivers (with ray tracing)')"
    check_can_install
    ask "Install them with apt now?" || die "nothing was installed. ./${0##*/} --no-setup goes on without this check."
    is_root || ! is_interactive || sudo -v || die "sudo did not let us"

    update_lists "Reading apt's package lists" || warn "apt-get update had errors; going on with the lists that are there"
    stanzas=
    if is_debian; then
        stanzas=$(missing_sources "$(needs_backports && echo yes || echo no)")
        [[ -n $stanzas && -n $(candidate_version yamagi-quake2) ]] && ! needs_backports && stanzas=
    fi
    if [[ -n $stanzas ]]; then
        say "apt needs these sources as well ($own_sources_file):"
        while IFS= read -r line; do note "$line"; done <<<"$stanzas"
        ask "Add them?" || die "without them yamagi-quake2 (contrib) or Mesa (backports) cannot be installed"
        write_own_sources "$stanzas"
        read_new_sources
    fi
    if [[ $mesa == yes ]]; then
        install_mesa || die "apt could not install Mesa's Vulkan drivers"
    fi
    mapfile -t missing < <(find_missing_packages)
    if ((${#missing[@]})); then
        install_packages apt-install "Installing ${#missing[@]} packages" "${missing[@]}" || die "apt could not install the packages"
    fi
    mapfile -t missing < <(find_missing_packages)
    ((${#missing[@]} == 0)) || die "still missing: ${missing[*]}"
}
