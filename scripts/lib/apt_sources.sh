# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# The sources that apt has on this machine, and the stanzas that it lacks for ref_vkpt.

apt_dir=${VKPT_APT_DIR:-/etc/apt} # another folder in the tests
# shellcheck disable=SC2034
own_sources_file=$apt_dir/sources.list.d/ref-vkpt.sources
debian_keyring=/usr/share/keyrings/debian-archive-keyring.gpg

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
release_number() { sed -n 's/^VERSION_ID="\?\([0-9.]*\)"\?$/\1/p' /etc/os-release; } # nothing in testing
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

# missing_sources WITH_BACKPORTS [WITH_CONTRIB]: the stanzas that this machine lacks. Each yes or no.
missing_sources() {
    local with_backports=$1 with_contrib=${2:-yes} codename archive uri signed
    codename=$(release_codename)
    archive=$(debian_archive)
    uri=${archive%%|*}
    signed=${archive#*|}
    emit() {
        printf 'Types: deb\nURIs: %s\nSuites: %s\nComponents: %s\n' "$uri" "$1" "$2"
        [[ -n $signed ]] && printf 'Signed-By: %s\n' "$signed"
        printf '\n'
    }
    [[ $with_contrib == no ]] || has_source "$codename" contrib || emit "$codename" contrib
    [[ $with_backports == no ]] || has_source "$codename-backports" main || emit "$codename-backports" main
}
