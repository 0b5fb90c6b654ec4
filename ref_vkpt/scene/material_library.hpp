// SPDX-License-Identifier: GPL-2.0-or-later
// What files and the player say that textures' surfaces are made of.
#pragma once

#include "formats/material_file.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// Below 0: not said.
struct MaterialSettings {
    float roughness = -1, metalness = -1;
    float pane_roughness = -1; // of what the map makes a thin pane
    uint32_t medium = shared::MEDIUM_NONE; // MEDIUM_* that it is where it is a liquid; MEDIUM_NONE: not said
    float specular_factor = 1; // times what the coat over the base reflects
    float base_factor = 1; // times the texture's colour
    int glow_threshold = -1; // 0: does not glow; else of 255
    float bump_scale = 1; // of the normal map's tilt
    float metalness_factor = 1; // times the alpha of the normal map
    float emissive_factor = 1; // times what glows
    float default_radiance = 1; // times what glows without the map's light value
    bool takes_light_value = true, takes_lightstyles = true; // see FaceTexture
    bool is_sky = false; // of walls: the sky is seen in their place
    bool is_invisible = false; // is not there at all, to the eye and to light
    bool is_screen = false; // shows what a camera sees
    glm::vec4 screen_area { 11 / 256.0f, 14 / 256.0f, 245 / 256.0f, 148 / 256.0f }; // left, top, right, bottom of 1
    // Files of the game; empty: none.
    std::string base_file, mask_file;
    std::optional<std::string> normals_file, emissive_file; // nothing: what lies beside the texture
    std::map<std::string, std::string, std::less<>> attributes; // all, as they are written
    std::vector<std::string> sources; // the files that they come from, in their order
    bool is_edited = false; // by the player, on top of that
};

class MaterialLibrary {
public:
    // Later files add to earlier ones, and replace what they say again.
    void add(const formats::MaterialFile& file);
    // What the player says goes before all files. An empty value takes the player's word back.
    void edit(std::string_view texture, std::string_view attribute, std::string_view value);
    // The player's edits, as they are saved; and those of an earlier run.
    std::vector<formats::MaterialEntry> edits() const;
    void take_edits(const formats::MaterialFile& file);
    // Of all files, but not of edits.
    void forget_files();

    // Of a material_name(); nullptr: nothing is said of that texture.
    const MaterialSettings* find(std::string_view name) const;

private:
    using Attributes = std::map<std::string, std::string, std::less<>>;
    using Names = std::map<std::string, Attributes, std::less<>>;
    static void add_to(Names& names, const formats::MaterialFile& file);
    void refresh(const std::string& name);

    Names files_, edits_;
    std::map<std::string, std::vector<std::string>, std::less<>> sources_; // of files_
    std::map<std::string, MaterialSettings, std::less<>> settings_;
};

} // namespace vkpt
