# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # root: see common.sh
# What is missing on this machine, and its installation with apt. Nothing here touches a machine that has everything.

. "$root/scripts/lib/apt_sources.sh"
. "$root/scripts/lib/apt_plan.sh"

raytracing_mesa=24.1 # the first Mesa whose CPU driver has ray queries
record_dir=${VKPT_RECORD_DIR:-/var/lib/ref_vkpt}
record_file=$record_dir/installed # what the set-up brought, for ./play --uninstall

needed_for='test' # or play: without the packages that only the tests need
read_package_list() {
    local last='$'
    [[ $needed_for == test ]] || last='/for .\/test only$/'
    sed -n "1,${last}p" "$root/scripts/packages.txt" | sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d'
}

# The listed packages that are not installed, one a line.
find_missing_packages() {
    local -a wanted
    mapfile -t wanted < <(read_package_list)
    comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) \
        <(dpkg-query --admindir="$dpkg_dir" -W -f '${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^installed //p' | sort -u)
}

# A machine with a GPU keeps its drivers, whatever they can do.
has_gpu() {
    local file
    for file in "$dev_dir"/dri/renderD* "$dev_dir"/nvidia0 "$proc_dir"/driver/nvidia/version; do
        [[ -e $file ]] && return 0
    done
    return 1
}
dev_dir=/dev proc_dir=/proc

mesa_traces_rays() {
    local version
    version=$(installed_version mesa-vulkan-drivers)
    [[ -n $version ]] && dpkg --compare-versions "$version" ge "$raytracing_mesa"
}

# Written when no newer Mesa can be had, so that the question comes once.
no_mesa_stamp=$root/build/log/no-newer-mesa
needs_mesa() {
    has_gpu && return 1
    mesa_traces_rays && return 1
    [[ ! -e $no_mesa_stamp || -z $(installed_version mesa-vulkan-drivers) ]]
}

# Mesa's stand-in for the kernel's part of GPU drivers, for scripts/check_gpu_drivers.sh. The tests do without it where it cannot be
# had; the question comes once.
no_shim_stamp=$root/build/log/no-drm-shim
needs_shim() {
    [[ $needed_for == test && ! -e $no_shim_stamp ]] && ! has_gpu && [[ -z $(installed_version mesa-drm-shim) ]]
}

# A GPU whose driver has no Vulkan is its owner's business; what helps is said.
warn_of_missing_driver() {
    local file
    has_gpu || return 0
    for file in "$vulkan_dir"/etc/vulkan/icd.d/*.json "$vulkan_dir"/usr/share/vulkan/icd.d/*.json "$vulkan_dir"/usr/local/share/vulkan/icd.d/*.json; do
        [[ -e $file ]] && return 0
    done
    warn "this machine has a GPU, and no Vulkan driver. The set-up leaves drivers alone. For AMD and Intel: apt install mesa-vulkan-drivers;
for NVIDIA: apt install nvidia-driver (component non-free), or the driver that you have from NVIDIA, with its Vulkan part."
}
vulkan_dir= # another root in the tests

# --- installing ---------------------------------------------------------------------------------------------------

as_root() {
    if is_root; then
        "$@"
    elif has_terminal; then
        sudo -- "$@"
    else
        sudo -n -- "$@"
    fi
}

run_apt() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 -o Dpkg::Use-Pty=0 "$@"
}
update_lists() { run_step apt-update "Reading apt's package lists" run_apt update; }

# may_change_system QUESTION REFUSAL OPTION: asks, unless that was answered beforehand; ends the script where it may or can not.
may_change_system() {
    local question=$1 refusal=$2 command="./${0##*/} $3"
    if ! has_agreed && ! has_terminal; then
        die "$refusal: there is no terminal to ask on. To agree in advance: $command --yes    (or set CI=true)"
    fi
    ask "$question" || die "$refusal"
    is_root && return 0
    has sudo || die "not root, and no sudo here. As root, run: $command"
    if has_terminal; then
        sudo -v || die "sudo refused. As root, run: $command"
    else
        sudo -n true 2>/dev/null || die "sudo asks for a password, which needs a terminal. As root, run: $command --yes"
    fi
}

check_own_key() {
    [[ $1 != *'Signed-By: inline'* ]] \
        || die "the Debian entry in /etc/apt has its key inline; add the component contrib to it by hand, then start again"
}

# Adds stanzas to our own file, which may hold some from an earlier set-up.
write_own_sources() {
    local text=$1 earlier=
    [[ -r $own_sources_file ]] && earlier=$(<"$own_sources_file")
    printf '%s\n\n%s\n' "${earlier:-# Written by ref_vkpt; ./play --uninstall removes it.}" "$text" \
        | as_root tee "$own_sources_file" >/dev/null || die "cannot write $own_sources_file"
}

restore_own_sources() {
    if [[ -n $1 ]]; then
        printf '%s\n' "$1" | as_root tee "$own_sources_file" >/dev/null
    else
        as_root rm -f "$own_sources_file"
    fi
}

# The record: lines "new NAME VERSION", and "upgrade NAME VERSION OLD". Written before apt starts, so that an
# installation that breaks off can be taken back as well.
write_record() {
    as_root mkdir -p "$record_dir" || die "cannot make $record_dir"
    cut -d' ' -f1-4 <<<"$plan_changes" | as_root tee -a "$record_file" >/dev/null || die "cannot write $record_file"
}

# Naming a package marks it as wanted for its own sake. libdrm's are not: what apt held for a mere dependency stays one.
restore_auto_marks() {
    local -a libraries
    mapfile -t libraries < <(printf '%s\n' "${plan_arguments[@]%%[/=]*}" | grep -vxF -e mesa-vulkan-drivers -e mesa-drm-shim -f <(read_package_list) \
        | grep -vxF -f <(printf '%s\n' "$manual_before") | sort -u)
    ((${#libraries[@]} == 0)) || as_root apt-mark auto "${libraries[@]}" >/dev/null 2>&1 || true
}

# check_plan_holds EARLIER-SOURCES: what the user agreed to is what happens: the real apt, asked now, has to say the same.
check_plan_holds() {
    local now
    now=$(LC_ALL=C system_apt -s install --no-install-recommends "${plan_arguments[@]}" 2>/dev/null | read_simulation)
    [[ $now == "$plan_changes" ]] && return 0
    restore_own_sources "$1"
    diff <(printf '%s\n' "$plan_changes") <(printf '%s\n' "$now") | sed -n 's/^[<>]/  &/p' | head -n 10 >&2
    die "apt's package lists have changed in the meantime (above: < before, > now); nothing was installed. Start again."
}
system_apt() { apt-get "$@"; }

install_plan() {
    local manual_before sources_before=
    [[ -r $own_sources_file ]] && sources_before=$(<"$own_sources_file")
    manual_before=$(apt-mark showmanual 2>/dev/null)
    [[ -z $plan_sources ]] || write_own_sources "$plan_sources"
    update_lists || warn "apt-get update had errors ($log_dir/apt-update.log); continuing with the lists that are there"
    check_plan_holds "$sources_before"
    write_record
    run_step apt-install "Installing $(count_changes new) packages" run_apt install -y --no-install-recommends "${plan_arguments[@]}" \
        || die "apt could not install the packages. ./play --uninstall removes what it did install."
    restore_auto_marks
}

# Installs what is missing. Quick (no apt, no network) where nothing is.
set_up_machine() {
    local -a missing
    local mesa=no shim=no
    if ! has dpkg-query; then
        warn "not a Debian system: the packages are not checked (scripts/packages.txt lists them)"
        return 0
    fi
    warn_of_missing_driver
    mapfile -t missing < <(find_missing_packages)
    needs_mesa && mesa=yes
    needs_shim && shim=yes
    ((${#missing[@]} == 0)) && [[ $mesa == no && $shim == no ]] && return 0

    [[ $mesa == no ]] || say "ref_vkpt needs Mesa's Vulkan driver for the CPU, in a version that traces rays."
    ((${#missing[@]} == 0)) || say "ref_vkpt needs ${#missing[@]} packages that are not installed."
    has apt-get || die "this system has no apt. Install the equivalents of: $(read_package_list | tr '\n' ' ')"
    plan_installation "$mesa" "$shim" ${missing[@]+"${missing[@]}"}
    if [[ -n $plan_changes ]]; then
        check_plan
        print_plan
        say "To do it by hand, as root: apt-get install --no-install-recommends ${plan_arguments[*]}"
        may_change_system "Do this now?" "nothing was installed" --setup-only
        install_plan
    fi
    [[ $mesa == no ]] || mesa_traces_rays || touch "$no_mesa_stamp"
    [[ $shim == no ]] || ! needs_shim || touch "$no_shim_stamp"
    mapfile -t missing < <(find_missing_packages)
    ((${#missing[@]} == 0)) || die "still missing: ${missing[*]}"
}
