// SPDX-License-Identifier: GPL-2.0-or-later
// Frames as a server or a recorded game may ask for them: views with nonsense in every number, lights, particles, 2D,
// registrations in any order. What the module does of it on the CPU, without a device. The input is a row of calls: a
// byte that says which, then its numbers.
#include "client/host/view_placement.hpp"
#include "fuzz/support/harness.hpp"
#include "fuzz/support/input.hpp"
#include "fuzz/support/moving.hpp"
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/draw2d/draw2d.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/scene/camera.hpp"
#include "ref_vkpt/scene/motion.hpp"
#include "ref_vkpt/scene/scene.hpp"
#include "tests/contract/mock_engine.hpp"
#include "tests/formats/samples.hpp"

#include <array>
#include <memory>

namespace {

using namespace vkpt;

std::string to_text(const std::vector<std::byte>& bytes)
{
    return { reinterpret_cast<const char*>(bytes.data()), bytes.size() };
}

// The sample map with its second face as brush model *1.
formats::Bsp make_map()
{
    formats::Bsp map = samples::make_bsp();
    map.models.push_back(map.models[0]);
    map.models[0].face_count = 1;
    map.models[1].first_face = 1;
    map.models[1].face_count = 1;
    map.models[1].head_node = -1;
    return map;
}

void add_files(tests::MockEngine& engine)
{
    engine.files["maps/sample.bsp"] = to_text(formats::write_bsp(make_map()));
    engine.files["models/a/tris.md2"] = to_text(formats::write_md2(samples::make_md2()));
    engine.files["sprites/s.sp2"] = to_text(formats::write_sp2(samples::make_sp2()));
    engine.files["pics/conchars.pcx"] = to_text(formats::write_pcx(samples::make_indexed_image(16, 16)));
    engine.files["pics/colormap.pcx"] = to_text(formats::write_pcx(samples::make_indexed_image(16, 16)));
    engine.files["env/sky_rt.tga"] = to_text(formats::write_tga(samples::make_image(4, 4)));
    engine.files["players/skin.pcx"] = to_text(formats::write_pcx(samples::make_indexed_image(4, 4)));
}

// No pipelines are made: Draw2d's constructor only takes the reference.
Pipelines& no_pipelines()
{
    alignas(16) static std::byte nothing[1024];
    return *reinterpret_cast<Pipelines*>(nothing);
}

// The module's CPU side, started once for all inputs.
class Session {
public:
    Session()
    {
        add_files(engine_);
        engine::attach(engine_.imports());
        cvars::register_all();
        textures_ = std::make_unique<TextureStore>(gpu_, bindings_, uploader_);
        scene_ = std::make_unique<Scene>(*textures_);
        draw2d_ = std::make_unique<Draw2d>(gpu_, bindings_, no_pipelines(), *textures_, 2);
    }

    void run(fuzz::Input& input)
    {
        reset();
        for (int calls = 0; !input.is_empty() && calls < 64; calls++)
            call(input);
        if (!entities_.empty() || !dlights_.empty() || !particles_.empty())
            show_view(input);
    }

private:
    static constexpr std::array<const char*, 8> names { "models/a/tris.md2", "sprites/s.sp2", "*1", "*0", "*7",
        "maps/sample.bsp", "none", "" };
    static constexpr std::array<const char*, 4> pictures { "conchars", "none", "/players/skin.pcx", "" };

    void reset()
    {
        engine_.console.clear();
        entities_.clear();
        dlights_.clear();
        particles_.clear();
        before_.reset(); // it points into the world
        register_map();
    }

    // All models that there are get a handle, as with the engine's client.
    void register_map()
    {
        before_.reset();
        scene_->begin_registration("sample");
        lights_ = { {}, scene_->world()->light_lists };
        scene_->set_sky("sky_", 1, { 0, 0, 1 });
        for (size_t i = 0; i < names.size(); i++)
            models_[i] = scene_->register_model(names[i]);
        skin_ = scene_->register_skin("players/skin.pcx");
        scene_->end_registration();
    }

    void call(fuzz::Input& input)
    {
        switch (input.take<uint8_t>() % 8) {
        case 0:
            add_entity(input);
            break;
        case 1:
            if (dlights_.size() < size_t(engine::max_dlights))
                dlights_.push_back(input.take<engine::DynamicLight>());
            break;
        case 2:
            if (particles_.size() < 64)
                particles_.push_back(input.take<engine::Particle>());
            break;
        case 3:
            show_view(input);
            break;
        case 4:
            draw(input);
            break;
        case 5:
            turn_sky(input);
            break;
        case 6:
            styles_[input.take<uint8_t>()] = input.take<engine::Lightstyle>();
            break;
        case 7:
            set_cvar(input);
            break;
        }
    }

    // As the engine's structure has it, with handles that are anything or that there are.
    void add_entity(fuzz::Input& input)
    {
        if (entities_.size() == size_t(engine::max_entities))
            return;
        const auto which = input.take<uint8_t>();
        auto entity = input.take<engine::Entity>();
        if (!(which & 0x40)) {
            entity.model = models_[which % models_.size()];
            entity.skin = which & 0x80 ? const_cast<Texture*>(skin_) : nullptr;
        }
        entities_.push_back(entity);
    }

    void show_view(fuzz::Input& input)
    {
        auto refdef = input.take<engine::RefDef>();
        refdef.area_bits = nullptr;
        refdef.lightstyles = styles_.data();
        refdef.entity_count = int32_t(entities_.size());
        refdef.entities = entities_.data();
        refdef.dlight_count = int32_t(dlights_.size());
        refdef.dlights = dlights_.data();
        refdef.particle_count = int32_t(particles_.size());
        refdef.particles = particles_.data();
        const Viewpoint view = make_viewpoint(refdef, { 640, 480 });
        fuzz::require(view.size.x > 0 && view.size.y > 0 && view.origin.x >= 0 && view.origin.y >= 0
                && view.size.x + uint32_t(view.origin.x) <= 640 && view.size.y + uint32_t(view.origin.y) <= 480,
            "a view lies in the picture");
        client::ViewPlacement(640, 480, 1280, 720).place_view(refdef);
        SceneSnapshot snapshot = scene_->take_snapshot(refdef, lights_);
        if (before_)
            find_previous_poses(snapshot, *before_);
        fuzz::write_moving(snapshot.moving);
        if (snapshot.world)
            before_ = std::make_unique<SceneSnapshot>(std::move(snapshot));
    }

    void draw(fuzz::Input& input)
    {
        const auto kind = input.take<uint8_t>();
        const Rectangle place
            = { input.take<int32_t>(), input.take<int32_t>(), input.take<int32_t>(), input.take<int32_t>() };
        const auto scale = input.take<float>();
        const auto tint = input.take<std::array<float, 3>>();
        const Texture* picture = textures_->find(pictures[kind / 8 % pictures.size()], TextureUse::image);
        draw2d_->begin_frame(0, {}, {});
        draw2d_->set_output(0, { 640, 480 });
        if (picture && kind % 8 == 0)
            draw2d_->draw_pic(*picture, place.x, place.y, scale, kind & 0x80 ? tint.data() : nullptr);
        if (picture && kind % 8 == 1)
            draw2d_->draw_stretched(*picture, place);
        if (picture && kind % 8 == 2)
            draw2d_->draw_tiled(*picture, place);
        if (kind % 8 == 3)
            draw2d_->draw_character(place.x, place.y, place.width, scale);
        if (kind % 8 == 4)
            draw2d_->draw_fill(place, place.width);
        if (kind % 8 == 5)
            draw2d_->draw_fade();
        if (kind % 8 == 6)
            draw_video(place, input);
        if (kind % 8 == 7)
            draw2d_->set_palette(kind & 0x80 ? reinterpret_cast<const uint8_t*>(pixels_.data()) : nullptr);
        draw2d_->record(VK_NULL_HANDLE);
    }

    void draw_video(const Rectangle& place, fuzz::Input& input)
    {
        const int columns = input.take<int8_t>(), rows = input.take<int8_t>(),
                  bits = input.take<uint8_t>() & 1 ? 32 : 8;
        draw2d_->draw_raw(place, columns, rows, reinterpret_cast<const uint8_t*>(pixels_.data()), bits);
    }

    void turn_sky(fuzz::Input& input)
    {
        const auto degrees = input.take<float>();
        const auto axis = input.take<glm::vec3>();
        scene_->set_sky(input.take<uint8_t>() & 1 ? "sky_" : "none", degrees, axis);
    }

    void set_cvar(fuzz::Input& input)
    {
        static constexpr std::array<const char*, 4> some { "hand", "r_gunfov", "pt_emission_scale", "pt_sky_scale" };
        const char* name = some[input.take<uint8_t>() % some.size()];
        engine_.set(name, std::to_string(input.take<float>()));
        cvars::update();
    }

    tests::MockEngine engine_;
    Device device_ { DeviceSettings() };
    MemoryAllocator memory_ { device_ };
    Gpu gpu_ { device_, memory_ };
    Bindings bindings_ { gpu_ };
    Uploader uploader_ { gpu_ };
    std::unique_ptr<TextureStore> textures_;
    std::unique_ptr<Scene> scene_;
    std::unique_ptr<Draw2d> draw2d_;
    std::array<void*, names.size()> models_ {};
    const Texture* skin_ = nullptr;
    ViewLights lights_;
    std::unique_ptr<SceneSnapshot> before_;
    std::vector<engine::Entity> entities_;
    std::vector<engine::DynamicLight> dlights_;
    std::vector<engine::Particle> particles_;
    std::array<engine::Lightstyle, engine::max_lightstyles> styles_ {};
    std::array<uint32_t, 128 * 128> pixels_ {};
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static Session session;
    fuzz::Input input(data, size);
    session.run(input);
    return 0;
}
