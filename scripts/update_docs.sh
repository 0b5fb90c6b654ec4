#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Writes the tables of console variables from the one list that the program has: docs/cvars.md and the README's table.
#   scripts/update_docs.sh            writes them
#   scripts/update_docs.sh --check    says whether they are current (exit status 1: no)
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
vkpt=$build_dir/bin/vkpt
[[ -x $vkpt ]] || die "$vkpt is not built"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$vkpt" info --cvars >"$folder/cvars.md" || die "vkpt info --cvars failed"
# The README has those of the first table that players set, with name, default and purpose; a bar inside a cell is written \|.
players_cvars='pt_bounces pt_light_sampler pt_accumulate flt_denoiser flt_taa pt_render_scale pt_target_ms pt_exposure_bias
    pt_bloom pt_emission_scale pt_sky_scale pt_dlight_scale pt_trace pt_device'
awk '/^## /{ table++ } table == 1 && /^\|/' "$folder/cvars.md" | sed 's/\\|/\x01/g' \
    | awk -F'|' '{ print "|" $2 "|" $3 "|" $6 "|" }' | sed 's/\x01/\\|/g' >"$folder/whole_table"
head -n 2 "$folder/whole_table" >"$folder/table"
for name in $players_cvars; do
    grep -F "| \`$name\` |" "$folder/whole_table" >>"$folder/table" || die "vkpt info --cvars has no $name, which the README names"
done
awk -v table="$folder/table" '
    /<!-- cvars end -->/ { inside = 0 }
    !inside { print }
    /<!-- cvars begin/ { inside = 1; while ((getline line < table) > 0) print line }' "$root/README.md" >"$folder/README.md"

if [[ ${1:-} == --check ]]; then
    cmp -s "$folder/cvars.md" "$root/docs/cvars.md" && cmp -s "$folder/README.md" "$root/README.md" && exit 0
    diff -u "$root/docs/cvars.md" "$folder/cvars.md" | head -n 20
    diff -u "$root/README.md" "$folder/README.md" | head -n 20
    die "docs/cvars.md or README.md is out of date: run scripts/update_docs.sh"
fi
cp "$folder/cvars.md" "$root/docs/cvars.md" && cp "$folder/README.md" "$root/README.md" && say "docs/cvars.md and README.md are current"
