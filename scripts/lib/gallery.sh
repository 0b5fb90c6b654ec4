# SPDX-License-Identifier: GPL-2.0-or-later
# The scenes of docs/gallery.md, for the scripts that draw and measure them.

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
