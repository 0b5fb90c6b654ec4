#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The parts of ref_vkpt stand on each other: no file includes one of a layer above its own. Names those that do.
#   scripts/check_layers.sh [FOLDER]   of the source tree at FOLDER (default: this one); exit status 1: there are some
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
top=${1:-$root}
[[ -d $top/ref_vkpt ]] || die_usage "$top has no ref_vkpt"

# From below to above; of two entries that fit a file the longer one counts. docs/architecture.md says what each part does.
layers='
common shaders/shared shaders/passes.def formats ref_vkpt/extension.hpp ref_vkpt/renderer.hpp ref_vkpt/engine/contract.hpp
ref_vkpt/engine ref_vkpt/cvars ref_vkpt/files ref_vkpt/free_memory ref_vkpt/noise ref_vkpt/preset ref_vkpt/pass_statistics ref_vkpt/workers
ref_vkpt/vulkan
ref_vkpt/lights
ref_vkpt/rays
ref_vkpt/scene
ref_vkpt/draw2d
ref_vkpt/frame
ref_vkpt/overlay
ref_vkpt/photo/ ref_vkpt/replay/
ref_vkpt/module.hpp ref_vkpt/scene_contents ref_vkpt/material_commands ref_vkpt/material_inspector ref_vkpt/picked_material ref_vkpt/photo_commands ref_vkpt/replay_commands ref_vkpt/light_inspector
ref_vkpt/renderer.cpp ref_vkpt/extension.cpp ref_vkpt/engine/exports.cpp'

cd "$top" || exit 1
found=$(grep -rHoE '^#include "[^"]+"' ref_vkpt shaders/shared formats common --include='*.[ch]pp' --include='*.h' \
    | awk -v layers="$layers" '
        function layer_of(path,    i, best, found) {
            found = -1
            for (i = 1; i <= count; i++)
                if (index(path, prefix[i]) == 1 && length(prefix[i]) > best) { best = length(prefix[i]); found = layer[i] }
            return found
        }
        BEGIN {
            lines = split(layers, line, "\n")
            for (i = 1; i <= lines; i++) {
                parts = split(line[i], part, " ")
                for (j = 1; j <= parts; j++) { prefix[++count] = part[j]; layer[count] = i }
            }
        }
        {
            split($0, half, ":#include \"")
            file = half[1]; target = half[2]; sub(/"$/, "", target)
            if (target !~ /\//) next # beside the file
            if (layer_of(file) < 0) { print file " is in no layer of scripts/check_layers.sh"; next }
            if (target ~ /^(ref_vkpt|shaders|formats|common)\// && layer_of(target) > layer_of(file)) print file " includes " target ", of a layer above"
        }' | sort -u)
[[ -z $found ]] && exit 0
say "$found"
exit 1
