# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# For scripts that run `vkpt bench` in turns: their start, before which they set `root` and go there.
. "$root/scripts/lib/common.sh"
. "$root/scripts/lib/gallery.sh"
help_if_asked "$@"
# shellcheck disable=SC2034
build=$build_dir
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# For awk: of a list of numbers with spaces between them.
# shellcheck disable=SC2034
awk_median='function median(list, count,   i, j, held, value) {
    split(list, value, " ")
    for (i = 2; i <= count; i++)
        for (j = i; j > 1 && value[j - 1] + 0 > value[j] + 0; j--) { held = value[j]; value[j] = value[j - 1]; value[j - 1] = held }
    return count % 2 ? value[(count + 1) / 2] : (value[count / 2] + value[count / 2 + 1]) / 2
}'
