#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# scripts/check_layers.sh, check_functions.sh and format_code.sh find what they are for.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
mkdir -p "$folder"/{ref_vkpt/{scene,frame,vulkan},shaders/shared,formats}

echo '#include "ref_vkpt/vulkan/device.hpp"' >"$folder/ref_vkpt/scene/scene.cpp"
echo '#include "ref_vkpt/scene/scene.hpp"' >"$folder/ref_vkpt/frame/frame.cpp"
"$root/scripts/check_layers.sh" "$folder" || fail "downward includes are none"
echo '#include "ref_vkpt/frame/frame.hpp"' >>"$folder/ref_vkpt/scene/scene.cpp"
found=$("$root/scripts/check_layers.sh" "$folder") && fail "an upward include was not found"
[[ $found == "ref_vkpt/scene/scene.cpp includes ref_vkpt/frame/frame.hpp, of a layer above" ]] || fail "$found"

# Of $1 lines, in a class.
write_function() {
    printf 'struct Some {\n    void act()\n    {\n'
    for ((i = 0; i < $1; i++)); do echo '        if (1) { }'; done
    printf '    }\n};\n'
}
write_function 60 >"$folder/ref_vkpt/frame/frame.cpp"
"$root/scripts/check_functions.sh" "$folder" || fail "60 lines are not too many"
write_function 61 >"$folder/ref_vkpt/frame/frame.cpp"
found=$("$root/scripts/check_functions.sh" "$folder") && fail "a function of 61 lines was not found"
[[ $found == *"frame.cpp:3: 61 lines: void act()" ]] || fail "$found"

mkdir "$folder/code" && cp "$root/.clang-format" "$folder/code"
printf 'int  f( );\n' >"$folder/code/some.cpp"
"$root/scripts/format_code.sh" --check "$folder/code" >"$folder/said"
status=$?
((status == 77)) && { echo "not checked: another version of clang-format"; exit 0; }
((status == 1)) && grep -q 'some.cpp is not formatted' "$folder/said" || fail "code that is not formatted was not found"
"$root/scripts/format_code.sh" "$folder/code" && "$root/scripts/format_code.sh" --check "$folder/code" || fail "formatted code is refused"
[[ $(<"$folder/code/some.cpp") == 'int f();' ]] || fail "$(<"$folder/code/some.cpp")"
