// SPDX-License-Identifier: GPL-2.0-or-later
// Files that are missing or damaged: a message that names them, and the next good map works.
#include "client/host/errors.hpp"
#include "formats/model.hpp"
#include "tests/formats/samples.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

namespace vkpt::tests {
namespace {

using client::Failure;

std::vector<std::byte> cut(std::vector<std::byte> bytes, double share)
{
    bytes.resize(size_t(double(bytes.size()) * share));
    return bytes;
}

class BadInput : public testing::Test {
protected:
    BadInput()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("wall"));
        map.add(rectangle({ 0, 0, 127 }, { 0, 32, 0 }, { 32, 0, 0 }), map.add_material("lamp", 0, 1000));
        map.begin_brush_model();
        map.add_block({ -10, -10, 0 }, { 10, 10, 20 }, map.add_material("wall"));
        good_ = map.finish();
        folder_.add_map("good", good_);
    }

    Session& start()
    {
        session_ = std::make_unique<Session>(folder_);
        return *session_;
    }

    // The message that the level is dropped with.
    std::string drop(const std::string& map)
    {
        try {
            session_->load_map(map);
        } catch (const Failure& failure) {
            return failure.what();
        }
        return "(loaded)";
    }

    void expect_good_map_works()
    {
        session_->load_map("good");
        session_->look({ -100, -100, 80 }, { 0, 0, 20 });
        session_->draw();
        EXPECT_FALSE(is_black(session_->capture()));
    }

    GameFolder folder_;
    formats::Bsp good_;
    std::unique_ptr<Session> session_;
};

TEST_F(BadInput, MissingMapIsNamed)
{
    start();
    EXPECT_NE(drop("nowhere").find("maps/nowhere.bsp"), std::string::npos);
    expect_good_map_works();
    // In the middle of a game, too; then there is no world to look at.
    EXPECT_NE(drop("nowhere").find("maps/nowhere.bsp"), std::string::npos);
    EXPECT_THROW(session_->draw(), Failure);
    expect_good_map_works();
}

TEST_F(BadInput, TruncatedMapsAreNamed)
{
    const std::vector<std::byte> whole = formats::write_bsp(good_);
    Session& session = start();
    for (const double share : { 0.0, 0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9 }) {
        folder_.add("maps/cut.bsp", cut(whole, share));
        session.files().add_file("maps/cut.bsp", folder_.path() / "baseq2/maps/cut.bsp");
        EXPECT_NE(drop("cut").find("maps/cut.bsp"), std::string::npos) << share << ": " << drop("cut");
        expect_good_map_works();
    }
}

TEST_F(BadInput, SenselessIndicesAreNamed)
{
    formats::Bsp bad = good_;
    bad.faces[0].texinfo = 999;
    folder_.add_map("bad", bad);
    start();
    EXPECT_NE(drop("bad").find("maps/bad.bsp"), std::string::npos);
    expect_good_map_works();
}

TEST_F(BadInput, DamagedTextureBecomesGrey)
{
    start();
    expect_good_map_works();
    session_ = nullptr;
    folder_.add("textures/wall.wal", std::vector<std::byte>(50, std::byte(0x7f)));
    start();
    expect_good_map_works();
    EXPECT_TRUE(session_->has_line("textures/wall.wal is damaged"));
    EXPECT_TRUE(session_->has_line("textures/wall.wal is missing or unusable: shown grey"));
}

TEST_F(BadInput, DamagedModelIsRefusedAndDrawnAsAPlaceholder)
{
    const std::vector<std::byte> whole = formats::write_md2(samples::make_md2());
    folder_.add("models/cut.md2", cut(whole, 0.6));
    folder_.add("models/cut.sp2", cut(formats::write_sp2(samples::make_sp2()), 0.6));
    Session& session = start();
    expect_good_map_works();
    const Radiance empty = session.capture();
    for (const char* name : { "models/cut.md2", "models/cut.sp2" }) {
        EXPECT_FALSE(session.module().register_model(name));
        EXPECT_TRUE(session.has_line(name));
    }
    EXPECT_FALSE(session.module().register_model("models/none.md2"));
    const engine::Entity entity = make_entity(nullptr, { 0, 0, 40 });
    session.view.entities = &entity;
    session.view.entity_count = 1;
    session.draw();
    EXPECT_FALSE(session.capture() == empty);
}

TEST_F(BadInput, DamagedReplacementLeavesTheModelItself)
{
    folder_.add("models/item.md2", formats::write_md2(samples::make_md2()));
    folder_.add("models/item.md3", cut(formats::write_md3(samples::make_md3()), 0.6));
    Session& session = start();
    expect_good_map_works();
    EXPECT_TRUE(session.module().register_model("models/item.md2"));
    EXPECT_TRUE(session.has_line("models/item.md3"));
    EXPECT_TRUE(session.has_line("models/item.md2 is shown in its place"));
}

TEST_F(BadInput, DamagedIqmIsNamedAndLeavesTheModelItself)
{
    folder_.add("models/arm.md2", formats::write_md2(samples::make_md2()));
    folder_.add("models/arm.iqm", cut(formats::write_iqm(samples::make_iqm()), 0.6));
    Session& session = start();
    expect_good_map_works();
    EXPECT_TRUE(session.module().register_model("models/arm.md2"));
    EXPECT_TRUE(session.has_line("models/arm.iqm: at byte"));
    EXPECT_TRUE(session.has_line("models/arm.md2 is shown in its place"));
    EXPECT_FALSE(session.module().register_model("models/arm.iqm"));
}

TEST_F(BadInput, BrushModelsThatTheMapLacksAreRefused)
{
    MapBuilder map;
    map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("wall"));
    folder_.add_map("plain", map.finish());
    Session& session = start();
    expect_good_map_works();
    EXPECT_TRUE(session.module().register_model("*1"));
    EXPECT_FALSE(session.module().register_model("*2"));
    session.module().begin_registration("plain");
    EXPECT_FALSE(session.module().register_model("*1"));
    session.module().end_registration();
    session.draw();
}

// A handle from before a change of maps that has not registered it again: drawn as a placeholder, as what there is not.
TEST_F(BadInput, HandlesOfAnEarlierMapAreDrawnAsPlaceholders)
{
    Session& session = start();
    const std::string cube = folder_.add_cube("cube", 8, red_index);
    folder_.add("models/sprite.sp2", formats::write_sp2(samples::make_sp2()));
    folder_.add("players/skin.pcx", formats::write_pcx(samples::make_indexed_image(8, 8)));
    for (const std::string& name : { cube, std::string("models/sprite.sp2"), std::string("players/skin.pcx") })
        session.files().add_file(name, folder_.path() / "baseq2" / name);
    expect_good_map_works();
    const Radiance empty = session.capture();
    std::array<void*, 3> handles {};
    for (size_t i = 0; const char* name : { cube.c_str(), "models/sprite.sp2", "*1" })
        handles[i++] = session.module().register_model(name);
    void* const skin = session.module().register_skin("players/skin.pcx");
    EXPECT_TRUE(handles[0] && handles[1] && handles[2] && skin);
    expect_good_map_works();
    for (void* const handle : handles) {
        engine::Entity entity = make_entity(handle, { 0, 0, 40 });
        entity.skin = skin;
        session.view.entities = &entity;
        session.view.entity_count = 1;
        session.draw();
        EXPECT_FALSE(session.capture() == empty);
    }
}

// The engine keeps explosions' handles over a restart of video: what they point at is gone with the module that made
// them.
TEST_F(BadInput, HandlesOfAnEarlierModuleAreDrawnAsPlaceholders)
{
    Session& session = start();
    const std::string cube = folder_.add_cube("cube", 8, red_index);
    session.files().add_file(cube, folder_.path() / "baseq2" / cube);
    expect_good_map_works();
    void* const model = session.module().register_model(cube.c_str());
    ASSERT_TRUE(model);
    const Radiance empty = session.capture();
    const long page = sysconf(_SC_PAGESIZE);
    void* const gone = mmap(nullptr, size_t(page), PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(gone, MAP_FAILED);
    for (void* const handle : { gone, static_cast<void*>(static_cast<char*>(model) + 8) }) {
        engine::Entity entities[] = { make_entity(handle, { 0, 0, 40 }), make_entity(model, { 40, 0, 40 }) };
        entities[1].skin = handle;
        engine::Entity weapon = make_entity(handle, { 0, 0, 40 }, engine::RF_WEAPONMODEL);
        for (engine::Entity* const shown : { &entities[0], &entities[1], &weapon }) {
            session.view.entities = shown;
            session.view.entity_count = 1;
            session.draw();
            EXPECT_FALSE(session.capture() == empty);
        }
    }
    session.view.entity_count = 0;
    munmap(gone, size_t(page));
}

// What the engine's entities may hold after a network hiccup.
// As `timerefresh` draws.
TEST_F(BadInput, ViewsThatAreTooManyAreToldOfOnceAFrame)
{
    start().load_map("good");
    const auto& module = session_->module();
    const auto told = [&] {
        return std::ranges::count_if(session_->lines(),
            [](const std::string& line) { return line.find("3D views in one frame") != std::string::npos; });
    };
    for (int frame = 1; frame <= 2; frame++) {
        module.begin_frame(0);
        for (int view = 0; view < 30; view++)
            module.render_frame(&session_->view);
        module.end_frame();
        EXPECT_EQ(told(), frame);
    }
    session_->draw(2);
    EXPECT_EQ(told(), 2);
}

TEST_F(BadInput, SenselessEntitiesAreNotDrawn)
{
    Session& session = start();
    expect_good_map_works();
    const std::string path = folder_.add_cube("cube", 8, red_index);
    session.files().add_file(path, folder_.path() / "baseq2" / path);
    void* cube = session.module().register_model(path.c_str());
    ASSERT_TRUE(cube);
    const Radiance empty = session.capture();
    engine::Entity lost = make_entity(cube, { NAN, INFINITY, -INFINITY });
    engine::Entity far = make_entity(cube, { 1e30f, 0, 0 });
    engine::Entity odd = make_entity(cube, { 0, 0, -500 });
    odd.frame = 1 << 30;
    odd.previous_frame = -7;
    odd.skin_number = 123456;
    odd.backlerp = NAN;
    const std::array<engine::Entity, 3> entities { lost, far, odd };
    const engine::DynamicLight light { { NAN, 0, 0 }, { INFINITY, 1, 1 }, NAN };
    session.view.entities = entities.data();
    session.view.entity_count = int32_t(entities.size());
    session.view.dlights = &light;
    session.view.dlight_count = 1;
    session.draw();
    const Radiance picture = session.capture();
    EXPECT_EQ(count_broken(picture), 0u);
    EXPECT_FALSE(is_black(picture));
}

} // namespace
} // namespace vkpt::tests
