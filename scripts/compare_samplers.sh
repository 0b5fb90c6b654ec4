#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The same frame of our map by every light sampler, one sample per pixel: pictures on one sheet, errors as a table.
#   scripts/compare_samplers.sh SHEET.png        (docs/images/light_samplers.png is made so)
# SCENE, SIZE, REFERENCE_SPP and NAME=VALUE pairs in SETTINGS change what is compared.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
[[ $# -eq 1 ]] || die "usage: scripts/compare_samplers.sh SHEET.png"
sheet=$1
scene=${SCENE:-maps/vkpt1.bsp}
size=${SIZE:-320x180}
reference_spp=${REFERENCE_SPP:-1024}
pictures=${PICTURES:-8} # that the error is averaged over
vkpt=$build_dir/bin/vkpt
picture_error=$build_dir/bin/picture_error
contact_sheet=$build_dir/scripts/contact_sheet
for program in "$vkpt" "$picture_error" "$contact_sheet"; do
    [[ -x $program ]] || die "$program is not built"
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

render() { # SAMPLER SPP SEED OUTPUT
    local settings=()
    for setting in ${SETTINGS:-}; do settings+=(--set "$setting"); done
    "$vkpt" render "$scene" --basedir "$build_dir/game" --size "$size" --spp "$2" --seed "$3" \
        --set pt_light_sampler="$1" --set pt_exposure=2 "${settings[@]}" -o "$4" || die "rendering with $1 failed"
}

samplers=(uniform full subset subset_onesweep subset_strides subset_mis subset_mis_biased ris)
for file in "$root"/shaders/light_samplers/*.glsl; do
    name=$(basename "$file" .glsl)
    [[ " ${samplers[*]} " == *" $name "* ]] || samplers+=("$name")
done
render "subset_mis" "$reference_spp" 1000 "$folder/reference.pfm"
render "subset_mis" $((reference_spp / 4)) 1000 "$folder/reference.png"
echo "| sampler | error (RMS / mean) | relative MSE |"
echo "|---|---|---|"
sheet_pictures=()
for sampler in "${samplers[@]}"; do
    files=()
    for ((seed = 1; seed <= pictures; seed++)); do
        render "$sampler" 1 "$seed" "$folder/$sampler.$seed.pfm"
        files+=("$folder/$sampler.$seed.pfm")
    done
    render "$sampler" 1 1 "$folder/$sampler.png"
    sheet_pictures+=("$folder/$sampler.png")
    "$picture_error" "$folder/reference.pfm" "${files[@]}" \
        | awk -v name="$sampler" '{ printf "| `%s` | %s | %s |\n", name, $2, $4 }'
done
"$contact_sheet" "$sheet" "${sheet_pictures[@]}" "$folder/reference.png" || die "no sheet"
say "$sheet: ${samplers[*]}, reference of $reference_spp samples"
