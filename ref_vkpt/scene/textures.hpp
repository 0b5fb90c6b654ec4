// SPDX-License-Identifier: GPL-2.0-or-later
// The textures on the device: found by name, uploaded once, each with a slot in the bindless table. Slot 0 is white.
#pragma once

#include "ref_vkpt/lights/face_triangles.hpp"
#include "ref_vkpt/scene/skin_lamps.hpp"
#include "ref_vkpt/scene/sky_sun.hpp"
#include "ref_vkpt/scene/texture_files.hpp"
#include "ref_vkpt/vulkan/bindings.hpp"
#include "ref_vkpt/vulkan/uploader.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace vkpt {

class MaterialLibrary;
struct MaterialSettings;

// The engine holds pointers to these and sorts entities by them: addresses are stable and ascend in the order of
// loading.
struct Texture {
    std::string name; // as asked for
    std::string path; // of the original texture: "textures/e1u1/floor.wal"
    std::string file; // what was read; empty: missing
    std::string material; // formats::material_name of `path`
    std::string base_file, mask_file; // that its material asked for
    TextureUse use = TextureUse::wall;
    uint32_t slot = 0; // bindless index
    uint32_t packed_size = 0x10001; // of what is in the slot, see shared::Material::texture_size
    int width = 0, height = 0; // of the original texture
    glm::vec3 average { 1 }; // see TextureMeasure
    std::vector<BrightPart> parts; // of walls, and of what glows
    float opaque_fraction = 1;
    std::optional<PaintedSun> sun; // of skies
    uint8_t brightest = 0; // component of all texels
    bool has_alpha = false;
    bool has_holes = false; // its material's mask has cut them
    bool missing = false; // grey in place of a wall that was not found
    // Of walls and skins: its normal map, and the picture of what of it glows.
    const Texture* normals = nullptr;
    const Texture* emissive = nullptr;
    GlowMap glow; // of what glows: for lamps
    uint32_t registration = 0; // the last one that used it; 0: free
    Image image; // not set: shares the slot of another
};

TextureMaps maps_of(const Texture& texture);

class TextureStore {
public:
    // Makes the white texture and loads the palette. `bindings` must be fresh: slot 0 becomes the white texture.
    TextureStore(const Gpu& gpu, Bindings& bindings, Uploader& uploader);
    ~TextureStore();
    TextureStore(const TextureStore&) = delete;
    TextureStore& operator=(const TextureStore&) = delete;

    // Names as in TextureUse. Loads what is not there yet and marks it used. A wall that is not found is a grey texture
    // of 64 x 64, named on the console once per map; anything else that is not found is nullptr.
    const Texture* find(std::string_view name, TextureUse use);
    // What files say of materials: maps and replacements of walls and skins. Counts for what is found from here
    // on, and from the next map on for what a map before had. Must outlive this.
    void use_materials(const MaterialLibrary& library) { library_ = &library; }
    // The six sides in the order of shared::Sky (rt, bk, lf, ft, up, dn); nullptr where a side is missing.
    std::array<const Texture*, 6> find_sky(std::string_view name);
    // A side of a sky that was made here, under a name that tells its settings; nullptr where there is no room.
    const Texture* add_sky_side(const std::string& name, const std::function<formats::Image()>& draw);
    // Marks a texture found earlier as used by this map.
    void touch(const Texture* texture);

    // nullptr: the handle is none of this store's, or of an earlier map.
    const Texture* of_handle(const void* handle) const;

    const Texture& white() const { return *white_; }
    // The game's. Alpha of entry 255 is 0.
    const formats::Palette& palette() const { return files_.palette(); }

    void begin_registration();
    // Frees what the new map does not use, except 2D textures. The device must be idle.
    void end_registration();
    uint32_t registration() const { return registration_; }

    // Before a frame is submitted that may show newly found textures.
    void flush_if_needed();

    // What is in each slot that is taken.
    std::map<uint32_t, const Texture*> by_slot() const;
    // How many are loaded.
    size_t count() const;
    // For the console command `imagelist`.
    void print_list() const;

private:
    using Names = std::map<std::string, Texture*, std::less<>>; // nullptr: searched and not found

    bool is_outdated(const Texture& texture, std::string_view name) const;
    Texture* load(std::string_view name, TextureUse use);
    Texture* add(Texture&& described, const LoadedTexture& loaded);
    const Texture* find_map(std::string_view name, TextureUse use, TextureUse map);
    // What of a wall or skin glows: its picture, or of skins the bright texels that their material speaks of.
    const Texture* find_emissive(std::string_view name, TextureUse use);
    const Texture* find_bright_texels(std::string_view skin, const MaterialSettings& settings);
    Texture* make_missing_wall(std::string_view name);
    Texture* take_entry();
    void release(Texture& texture);
    void upload(Texture& texture, const formats::Image& pixels);
    void upload_levels(Texture& texture, const formats::Image& first,
        const std::function<const formats::Image&(uint32_t level)>& next_level);
    void measure(Texture& texture, const formats::Image& pixels) const;

    Gpu gpu_;
    Bindings& bindings_;
    Uploader& uploader_;
    TextureFiles files_;
    const MaterialLibrary* library_ = nullptr;
    size_t capacity_;
    std::unique_ptr<Texture[]> entries_;
    std::set<size_t> free_entries_; // lowest first, so that two runs hand out the same order
    std::array<Names, texture_use_count> names_;
    Texture* white_ = nullptr;
    Texture* grey_ = nullptr;
    uint32_t registration_ = 1;
    bool upload_pending_ = false;
    bool said_full_ = false;
};

} // namespace vkpt
