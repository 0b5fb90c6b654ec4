# SPDX-License-Identifier: GPL-2.0-or-later
# The scenes of docs/gallery.md, for the scripts that draw and measure them.

# Where each picture is taken from.
declare -A gallery_scenes=(
    [water]=maps/looks.bsp@-330,-230,120,40,75
    [slime_lava]=maps/looks.bsp@60,-330,130,22,80
    [glass]=maps/looks.bsp@-200,170,90,12,70
    [under_water]=maps/vkpt1.bsp@-600,-60,-100,10,90
    [god_rays]=maps/looks.bsp@330,215,40,-14,80
    [fog]=maps/looks.bsp@60,-480,150,15,90
    [physical_sky]=maps/vkpt1.bsp@0,520,200,-5,90
    [flashlight]=maps/vkpt1.bsp@-440,100,60,10,-135
    [wipe]=maps/vkpt1.bsp@0,-384,54,0,90
    [screens]=maps/screens.bsp@690,520,150,3,-30
    [body]=maps/vkpt1.bsp@0,-360,46,0,-90
    [lens]=maps/vkpt1.bsp@0,-384,46,0,90
)

# make_gallery_data BASEDIR: the build's game data, docs/gallery/looks.map compiled, and our map once more, with a camera.
make_gallery_data() {
    local maps=$1/baseq2/maps
    mkdir -p "$maps/cameras"
    cp -r "$build/game/baseq2/." "$1/baseq2/"
    "$build/tools/map_compiler/vkpt_map" docs/gallery/looks.map -o "$maps/looks.bsp" --textures "$build/game/baseq2/textures"
    cp docs/gallery/looks.lights docs/gallery/looks.mat docs/gallery/screens.mat "$maps/"
    cp "$maps/vkpt1.bsp" "$maps/screens.bsp"
    cp docs/gallery/screens.txt "$maps/cameras/"
}

# make_bare_map BASEDIR: looks.map without its liquids and glass, as maps/bare.bsp.
make_bare_map() {
    local maps=$1/baseq2/maps
    awk -v textures=" vkpt/water vkpt/slime vkpt/lava vkpt/lamp_cyan vkpt/lamp_green vkpt/lamp_magenta " '
        /^\{/ { depth++; if (depth == 2) { brush = ""; wanted = 1 } }
        depth == 2 { brush = brush $0 "\n"; if (index(textures, " " $16 " ")) wanted = 0 }
        depth != 2 { print }
        /^\}/ { if (depth == 2 && wanted) printf "%s", brush; depth-- }' docs/gallery/looks.map >"$1/bare.map"
    "$build/tools/map_compiler/vkpt_map" "$1/bare.map" -o "$maps/bare.bsp" --textures "$build/game/baseq2/textures"
    cp docs/gallery/looks.lights "$maps/bare.lights"
    cp docs/gallery/looks.mat "$maps/bare.mat"
}

# is_wanted NAME...: whether one of them is among `wanted`, the names that the script was given; all are if it was given none.
is_wanted() {
    local name
    for name in "$@"; do [[ ${#wanted[@]} -gt 0 && " ${wanted[*]} " != *" $name "* ]] || return 0; done
    return 1
}
