# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # record_file and others: see setup.sh and apt_plan.sh
# Taking back what the set-up brought, by its record: packages that were not there before and that nothing else needs by now, newer
# versions where apt still has the earlier ones, and the sources file.

recorded() { [[ -r $record_file ]] && awk -v kind="$1" '$1 == kind' "$record_file" | sort -u; }

# The recorded packages that are installed and that no other package of the machine depends on: apt is asked with a copy of its marks
# in which all of them are mere dependencies.
print_removable() {
    local name marks=$plan_dir/extended_states
    local -a installed=()
    while read -r _ name _; do
        [[ -n $(installed_version "$name") ]] && installed+=("$name")
    done < <(recorded new)
    ((${#installed[@]})) || return 0
    cp "$apt_marks" "$marks" 2>/dev/null || : >"$marks"
    printf 'Dir::State::extended_states "%s";\nAPT::AutoRemove::RecommendsImportant "false";\nAPT::AutoRemove::SuggestsImportant "false";\n' "$marks" \
        >>"$plan_dir/apt.conf"
    plan_apt apt-mark auto "${installed[@]}" >/dev/null || die "apt-mark cannot read this machine's packages"
    plan_apt apt-get -s autoremove 2>/dev/null | read_simulation | awk '$1 == "remove" { print $2 }' \
        | grep -xF -f <(printf '%s\n' "${installed[@]}")
}
apt_marks=/var/lib/apt/extended_states

# Upgraded packages that are still of our version: NAME=OLD where apt has the earlier one.
print_downgrades() {
    local name version old
    while read -r _ name version old; do
        [[ $(installed_version "$name") == "$version" ]] && plan_has_version "$name" "$old" && echo "$name=$old"
    done < <(recorded upgrade)
}

# Sets uninstall_arguments (of apt-get install) and plan_changes.
declare -a uninstall_arguments=()
plan_uninstallation() {
    local -a removals downgrades
    local allowed changes foreign
    copy_apt_state ''
    mapfile -t removals < <(print_removable)
    mapfile -t downgrades < <(print_downgrades)
    allowed=$(printf '%s\n' "${removals[@]}" "${downgrades[@]%%=*}")
    for uninstall_arguments in "${removals[*]/%/-} ${downgrades[*]}" "${removals[*]/%/-}" ''; do
        read -ra uninstall_arguments <<<"$uninstall_arguments"
        plan_changes=
        ((${#uninstall_arguments[@]})) || break
        changes=$(plan_apt apt-get -s install --purge --allow-downgrades --no-install-recommends "${uninstall_arguments[@]}" 2>/dev/null) || continue
        plan_changes=$(read_simulation <<<"$changes" | sort -u -k1,2)
        # Nothing but what we brought: an earlier version that others cannot do with stays away.
        foreign=$(cut -d' ' -f2 <<<"$plan_changes" | grep -vxF "$allowed")
        [[ -n $foreign ]] || break
    done
    rm -rf "$plan_dir"
}

print_uninstallation() {
    local name version kept
    if [[ -n $plan_changes ]] && (($(count_changes remove))); then
        say "These $(count_changes remove) packages came with the set-up and would be removed:"
        print_names remove
    fi
    if [[ -n $plan_changes ]] && (($(count_changes upgrade))); then
        say "These would be downgraded to their earlier version:"
        print_names upgrade
    fi
    kept=$(while read -r _ name version _; do
        [[ -n $(installed_version "$name") ]] && ! grep -q "^remove $name " <<<"$plan_changes" && echo "$name"
    done < <(recorded new) | paste -sd' ')
    [[ -z $kept ]] || say "These stay, because other packages need them by now: $kept"
    kept=$(while read -r _ name version old; do
        [[ $(installed_version "$name") == "$version" ]] && ! grep -q "^upgrade $name " <<<"$plan_changes" && echo "$name ($version; it was $old)"
    done < <(recorded upgrade) | paste -sd',' | sed 's/,/, /g')
    [[ -z $kept ]] || say "These stay in their newer version, because apt does not have the earlier one or others need the newer: $kept"
    [[ ! -e $own_sources_file ]] || say "The file $own_sources_file would be removed."
}

uninstall_from_machine() {
    if [[ ! -e $record_file && ! -e $own_sources_file ]]; then
        say "Nothing to remove: the set-up has installed nothing on this machine."
        return 0
    fi
    plan_uninstallation
    print_uninstallation
    may_change_system "Remove them now?" "nothing was removed" --uninstall
    if ((${#uninstall_arguments[@]})); then
        run_step apt-remove "Removing packages" run_apt install -y --purge --allow-downgrades --no-install-recommends "${uninstall_arguments[@]}" \
            || die "apt could not remove the packages; nothing else was removed"
    fi
    as_root rm -f "$own_sources_file" "$record_file"
    [[ ! -d $record_dir ]] || as_root rmdir "$record_dir"
    update_lists || warn "apt-get update had errors ($log_dir/apt-update.log)"
    say "Removed. The build is in $root/build; delete that folder by hand."
}
