#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Writes the tables that come from the program's lists: docs/cvars.md, the README's table of console variables, docs/passes.md.
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
"$vkpt" info --passes >"$folder/passes.md" || die "vkpt info --passes failed"
# The README has those of the first table that players set, with name, default and purpose; a bar inside a cell is written \|.
players_cvars='pt_bounces pt_light_sampler pt_accumulate flt_denoiser flt_taa pt_render_scale pt_target_ms pt_exposure_bias
    pt_bloom pt_emission_scale pt_sky_scale pt_dlight_scale pt_trace pt_device'
awk '/^## /{ table++ } table == 1 && /^\|/' "$folder/cvars.md" | sed 's/\\|/\x01/g' \
    | awk -F'|' '{ print "|" $2 "|" $3 "|" $7 ($6 ~ /vid_restart/ ? "Counts after `vid_restart`. |" : "|") }' | sed 's/\x01/\\|/g' >"$folder/whole_table"
head -n 2 "$folder/whole_table" >"$folder/table"
for name in $players_cvars; do
    grep -F "| \`$name\` |" "$folder/whole_table" >>"$folder/table" || die "vkpt info --cvars has no $name, which the README names"
done
awk -v table="$folder/table" '
    /<!-- cvars end -->/ { inside = 0 }
    !inside { print }
    /<!-- cvars begin/ { inside = 1; while ((getline line < table) > 0) print line }' "$root/README.md" >"$folder/README.md"

if [[ ${1:-} == --check ]]; then
    outdated=
    for page in docs/cvars.md docs/passes.md README.md; do
        cmp -s "$folder/${page##*/}" "$root/$page" && continue
        diff -u "$root/$page" "$folder/${page##*/}" | head -n 20
        outdated+=" $page"
    done
    [[ -z $outdated ]] || die "out of date:$outdated: run scripts/update_docs.sh"
    exit 0
fi
cp "$folder/cvars.md" "$folder/passes.md" "$root/docs/" && cp "$folder/README.md" "$root/README.md" \
    && say "docs/cvars.md, docs/passes.md and README.md are current"
