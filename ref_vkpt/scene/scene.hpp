// SPDX-License-Identifier: GPL-2.0-or-later
// What the engine has registered (map, models, skins, sky), and how a refdef of it becomes a SceneSnapshot.
#pragma once

#include "formats/light_code.hpp"
#include "formats/model.hpp"
#include "ref_vkpt/engine/contract.hpp"
#include "ref_vkpt/lights/view_lights.hpp"
#include "ref_vkpt/scene/material_library.hpp"
#include "ref_vkpt/scene/physical_sky.hpp"
#include "ref_vkpt/scene/player_body.hpp"
#include "ref_vkpt/scene/snapshot.hpp"
#include "ref_vkpt/scene/textures.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace vkpt {

// The player's edits of materials, below the game's folder; the file begins with this line.
inline constexpr const char* saved_materials_path = "vkpt/materials.mat";
inline constexpr std::string_view saved_materials_head = "# Materials saved by ref_vkpt's command mat\n";

// A handle that the engine holds. Brush models belong to the current map.
struct Model {
    // An MD2, or a surface of an MD3.
    struct Part {
        std::shared_ptr<const Md2Mesh> md2; // views may outlive a model's registration
        std::vector<std::string> skin_names;
        std::vector<const Texture*> skins; // nullptr: not found
    };
    struct Mesh {
        std::vector<Part> parts; // one at least
    };
    struct Sprite {
        formats::Sp2Sprite sp2;
        std::vector<const Texture*> textures;
    };
    struct Brush {
        size_t index = 0; // in World::models; 0: the world itself
    };
    std::string name;
    std::string file; // what it was read from; that of a mesh may be another one, which stands for it
    std::optional<formats::LightModel> light; // by its name
    std::variant<Mesh, Sprite, Brush> shape;
    uint32_t registration = 0; // the last one that used it; 0: free
};

class Scene {
public:
    explicit Scene(TextureStore& textures);

    // Throws formats::FormatError or LevelError.
    void begin_registration(std::string_view map);
    // nullptr: no such model; the engine then shows a placeholder.
    Model* register_model(std::string_view name);
    const Texture* register_skin(std::string_view name);
    void set_sky(std::string_view name, float degrees_per_second, glm::vec3 axis);
    void end_registration();

    // nullptr before the first map.
    const std::string& map_path() const { return map_path_; } // "maps/NAME.bsp"
    const World* world() const { return world_.get(); }

    // Of the map, which there has to be.
    MapLights& map_lights();

    MaterialLibrary& materials() { return materials_; }
    const MaterialLibrary& materials() const { return materials_; }

    // The scene of a refdef. RDF_NOWORLDMODEL: models alone, with a light of their own; then `lights` stay as they are.
    // Else they go on by a frame, from one of this map to the next, and the snapshot refers to them.
    // `player`: what the player sees, where `refdef` is of another camera, to which the player's body is shown.
    SceneSnapshot take_snapshot(const engine::RefDef& refdef, ViewLights& lights,
        const engine::RefDef* player = nullptr, bool looks_around = false);

    void print_models() const;

private:
    struct SkyState {
        std::array<const Texture*, 6> textures {};
        bool present = false;
        float degrees_per_second = 0;
        glm::vec3 axis { 0, 0, 1 };
        glm::vec3 average { 0 };
        float scale = 1; // from texture to radiance
        std::optional<Sun> sun; // in the sky's space: painted on it, and made to shine
        std::optional<PhysicalSky> physical; // pt_sky physical: it is drawn as that
    };
    std::optional<Model> load_model(const std::string& name) const;
    Model* keep_model(Model model);
    void find_textures(Model& model);
    shared::Sky make_sky(float time) const;
    Model* find_model(std::string_view name);
    // A refdef whose entities have no handles but those of this map, or nullptr.
    struct CheckedView {
        std::vector<engine::Entity> entities;
        engine::RefDef refdef;
    };
    CheckedView check_handles(const engine::RefDef& refdef) const;
    std::vector<engine::Entity> find_player_body(const engine::RefDef& refdef);
    void find_sky_sun();
    void set_physical_sky();
    void light_physical_sky();
    std::vector<Sun> find_suns_of_moment(const shared::Sky& sky) const;
    void load_materials(std::string_view map);

    TextureStore& textures_;
    SkinLampCache skin_lamps_;
    std::string map_path_;
    std::unique_ptr<World> world_;
    std::optional<MapLights> map_lights_; // of world_; made when first asked for
    // The engine sorts entities by model pointer: handing out ascending addresses makes runs alike.
    std::vector<Model> models_; // never reallocated
    uint32_t registration_ = 0;
    SkyState sky_;
    PlayerBody player_body_;
    MaterialLibrary materials_;
    bool has_edits_ = false; // those that an earlier run saved are there
};

} // namespace vkpt
