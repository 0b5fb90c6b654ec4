// SPDX-License-Identifier: GPL-2.0-or-later
// What light and looks meet on their way: fences, the player's body, water, pictures on walls. By points whose light is
// known, and by pixels whose rays are followed here, too.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float lamp_height = 200, fence_height = 20;

// A small lamp high above a white floor.
MapBuilder make_lamp_map()
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 256, 0, 0 }, { 0, 256, 0 }), map.add_material("white"));
    map.add(rectangle({ 0, 0, lamp_height }, { 0, 2, 0 }, { 2, 0, 0 }), map.add_material("lamp", 0, 30000));
    return map;
}

// A lamp that shines upwards alone, so that the floor sees what is above by bounces. A sheet hides its back.
MapBuilder make_uplight_map()
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 9 }, { 0, 20, 0 }, { 20, 0, 0 }), map.add_material("white"));
    map.add(rectangle({ 0, 0, 10 }, { 16, 0, 0 }, { 0, 16, 0 }), map.add_material("lamp", 0, 30000));
    return map;
}

// A pool with a plane of red and green halves at `height`, which shine.
void add_pool(MapBuilder& map, float height, float border)
{
    constexpr float half = 300;
    const uint16_t water = map.add_material("white", formats::SURF_TRANS66 | formats::SURF_WARP);
    const Polygon surface = rectangle({ 0, 0, 0 }, { half, 0, 0 }, { 0, half, 0 });
    map.add(surface, water);
    map.add({ surface.rbegin(), surface.rend() }, water);
    const float side = height < 0 ? 1 : -1; // faces the water
    const glm::vec3 across(0, side * half, 0);
    const float left = (border - half) / 2, right = (border + half) / 2;
    map.add(rectangle({ left, 0, height }, { border - left, 0, 0 }, across), map.add_material("red", 0, 1000));
    map.add(rectangle({ right, 0, height }, { half - right, 0, 0 }, across), map.add_material("green", 0, 1000));
}

constexpr int picture_texels = 64;

void add_picture(const GameFolder& folder, const std::string& name, const std::function<bool(int, int)>& is_red)
{
    formats::Image picture { picture_texels, picture_texels, {} };
    for (int y = 0; y < picture_texels; y++)
        for (int x = 0; x < picture_texels; x++)
            picture.pixels.push_back(
                is_red(x, y) ? formats::Rgba8 { 255, 0, 0, 255 } : formats::Rgba8 { 0, 255, 0, 255 });
    folder.add_wall(name, white_index); // 16 x 16 texels of texinfo space
    folder.add("textures/" + name + ".tga", formats::write_tga(picture));
}

// A wall whose material has the holes of GameFolder::add_fence.
void add_mask(const GameFolder& folder, const std::string& name)
{
    folder.add_wall(name, white_index);
    formats::Image mask { 16, 16, std::vector<formats::Rgba8>(256, formats::Rgba8 { 0, 0, 0, 255 }) };
    for (size_t i = 0; i < mask.pixels.size(); i++)
        if (i % 16 < 8)
            mask.pixels[i].r = 255;
    folder.add("masks/bars.tga", formats::write_tga(mask));
    folder.add_text("maps/masked.mat", name + ":\n    texture_mask masks/bars\n");
}

constexpr float blocked_heights[] = { 0.1f, 1.0f, 100.0f, lamp_height - 2, lamp_height - 0.25f };
constexpr float pool_floor = -80, floor_border = 10, pool_ceiling = 90, ceiling_border = 20;

void add_lamp_maps(const GameFolder& folder)
{
    folder.add_map("open", make_lamp_map().finish());
    MapBuilder fenced = make_lamp_map();
    fenced.add(rectangle({ 0, 0, fence_height }, { 200, 0, 0 }, { 0, 200, 0 }),
        fenced.add_material("fence", formats::SURF_ALPHATEST));
    folder.add_map("fenced", fenced.finish());
    MapBuilder masked = make_lamp_map();
    masked.add(rectangle({ 0, 0, fence_height }, { 200, 0, 0 }, { 0, 200, 0 }), masked.add_material("masked"));
    folder.add_map("masked", masked.finish());
    const auto add_sheet = [&](const std::string& name, float height) {
        MapBuilder map = make_lamp_map();
        map.add(rectangle({ 0, 0, height }, { 40, 0, 0 }, { 0, 40, 0 }), map.add_material("white"));
        folder.add_map(name, map.finish());
    };
    for (size_t i = 0; i < std::size(blocked_heights); i++)
        add_sheet("blocked" + std::to_string(i), blocked_heights[i]);
    add_sheet("roofed", lamp_height + 0.25f);
}

void add_uplight_maps(const GameFolder& folder)
{
    folder.add_map("uplight", make_uplight_map().finish());
    for (const auto& [texture, flags] :
        { std::pair { "white", uint32_t(0) }, std::pair { "fence", uint32_t(formats::SURF_ALPHATEST) } }) {
        MapBuilder map = make_uplight_map();
        map.add(rectangle({ 0, 0, 100 }, { 160, 0, 0 }, { 0, 160, 0 }), map.add_material(texture, flags));
        folder.add_map(std::string("under_") + texture, map.finish());
    }
}

void add_other_maps(const GameFolder& folder)
{
    MapBuilder lit;
    lit.add_lit_room("white");
    folder.add_map("lit", lit.finish());
    MapBuilder into, out;
    add_pool(into, pool_floor, floor_border);
    add_pool(out, pool_ceiling, ceiling_border);
    folder.add_map("pool_floor", into.finish());
    folder.add_map("pool_ceiling", out.finish());
    MapBuilder deep;
    deep.add(rectangle({ 400, 0, 0 }, { 0, -300, 0 }, { 0, 0, 300 }), deep.add_material("lamp", 0, 1000));
    folder.add_map("deep", deep.finish());
}

void add_picture_maps(const GameFolder& folder)
{
    add_picture(folder, "stripes", [](int x, int) { return x < picture_texels / 2; });
    add_picture(folder, "squares", [](int x, int y) { return (x + y) % 2 == 0; });
    for (const auto& [picture, flags] :
        { std::pair { "stripes", uint32_t(formats::SURF_FLOWING) }, std::pair { "squares", uint32_t(0) } }) {
        MapBuilder map;
        map.add(rectangle({ 0, 0, 0 }, { 512, 0, 0 }, { 0, 512, 0 }), map.add_material(picture, flags));
        folder.add_map(picture, map.finish());
    }
}

class Optics : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("white", white_index);
        folder_->add_wall("lamp", white_index);
        folder_->add_wall("red", red_index);
        folder_->add_wall("green", green_index);
        folder_->add_fence("fence", white_index);
        add_mask(*folder_, "masked");
        folder_->add_cube("cube", 8, red_index);
        folder_->add_cube("large", 30, red_index);
        add_lamp_maps(*folder_);
        add_uplight_maps(*folder_);
        add_other_maps(*folder_);
        add_picture_maps(*folder_);
        session_
            = std::make_unique<Session>(*folder_, CvarList { { "pt_bounces", "0" }, { "pt_roughness_default", "1" } });
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        for (const auto& [name, value] : CvarList { { "pt_bounces", "0" }, { "pt_max_radiance", "0" },
                 { "pt_debug_view", "off" }, { "pt_accumulate", "0" } })
            session_->set(name, value);
        session_->view.flags = 0;
        session_->view.time = 0;
        session_->view.entities = nullptr;
        session_->view.entity_count = 0;
    }

    static void load(const std::string& name)
    {
        session_->load_map(name);
        session_->look({ 0, 0, 100 }, { 1, 0, 100 });
    }

    // Irradiance / pi of a point that faces up, and of nothing else.
    static float light_at(glm::vec3 place, uint32_t samples = 16)
    {
        constexpr size_t copies = 256;
        const std::vector<IrradianceProbe> probes(copies, { { place.x, place.y, place.z }, { 0, 0, 1 } });
        double sum = 0;
        for (const glm::vec3& value : session_->probe(probes, samples))
            sum += double(value.y);
        return float(sum / copies);
    }

    // With one thing in the scene.
    static float light_with(const char* model, glm::vec3 origin, int32_t flags, glm::vec3 place, uint32_t samples = 16)
    {
        const engine::Entity entity = make_entity(session_->module().register_model(model), origin, flags);
        EXPECT_TRUE(entity.model);
        session_->view.entities = &entity;
        session_->view.entity_count = 1;
        const float light = light_at(place, samples);
        session_->view.entities = nullptr;
        session_->view.entity_count = 0;
        return light;
    }

    // Every pixel whose colour is told is as red, or as green, as its ray says.
    static void expect_colours(
        const Radiance& picture, const std::function<std::optional<bool>(const CameraRay&)>& is_red, int min_told)
    {
        int told = 0, wrong = 0, red_ones = 0;
        for (int y = 0; y < picture.height; y++)
            for (int x = 0; x < picture.width; x++) {
                const std::optional<bool> red = is_red(camera_ray(session_->view, { x + 0.5f, y + 0.5f }));
                if (!red)
                    continue;
                told++;
                red_ones += *red;
                const glm::vec3 seen = picture.at(x, y);
                wrong += (seen.x > seen.y) != *red || seen == glm::vec3(0);
            }
        EXPECT_GT(told, min_told);
        EXPECT_GT(red_ones, told / 8);
        EXPECT_LT(red_ones, told - told / 8);
        EXPECT_EQ(wrong, 0) << "of " << told;
    }

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
};

// ---- shadows

TEST_F(Optics, FencesThrowTheShadowOfTheirBars)
{
    // Bars are where the picture's columns are 0 to 7, holes where they are 8 to 15.
    const float towards_lamp = 1 - fence_height / lamp_height;
    const glm::vec3 behind_bar(4 / towards_lamp, 1, 0), behind_hole(12 / towards_lamp, 1, 0);
    load("open");
    const float lit[] = { light_at(behind_bar), light_at(behind_hole) };
    EXPECT_GT(lit[0], 0.01f);
    for (const char* map : { "fenced", "masked" }) {
        load(map);
        EXPECT_EQ(light_at(behind_bar), 0) << map;
        EXPECT_NEAR(light_at(behind_hole), lit[1], 1e-4f * lit[1]) << map;
    }
}

TEST_F(Optics, TheOwnBodyThrowsAShadowAndTheWeaponNone)
{
    load("open");
    const glm::vec3 body(0, 0, 60);
    const float lit = light_at({ 0, 0, 0 });
    EXPECT_GT(lit, 0.01f);
    EXPECT_EQ(light_with("models/cube.md2", body, 0, { 0, 0, 0 }), 0);
    EXPECT_EQ(light_with("models/cube.md2", body, engine::RF_VIEWERMODEL, { 0, 0, 0 }), 0);
    EXPECT_EQ(light_with("models/cube.md2", body, engine::RF_WEAPONMODEL, { 0, 0, 0 }), lit);
}

// What shadows may stand right before the lamp, and right before what is lit.
TEST_F(Optics, ShadowsReachFromTheSurfaceToTheLamp)
{
    for (size_t i = 0; i < std::size(blocked_heights); i++) {
        load("blocked" + std::to_string(i));
        EXPECT_EQ(light_at({ 0, 0, 0 }), 0) << "a sheet at " << blocked_heights[i];
    }
    load("roofed"); // and no farther
    EXPECT_GT(light_at({ 0, 0, 0 }), 0.01f);
}

// ---- bounces

TEST_F(Optics, BouncesMeetTheBarsOfFences)
{
    session_->set("pt_bounces", 1);
    const glm::vec3 place(60, 0, 0);
    float light[3] {};
    const char* const maps[] = { "uplight", "under_white", "under_fence" };
    for (int i = 0; i < 3; i++) {
        load(maps[i]);
        light[i] = light_at(place, 64);
    }
    EXPECT_EQ(light[0], 0);
    EXPECT_GT(light[1], 0.01f);
    EXPECT_NEAR(light[2], light[1] / 2, 0.05f * light[1]); // half of it is holes
}

TEST_F(Optics, BouncesMeetTheOwnBodyAndNotTheWeapon)
{
    session_->set("pt_bounces", 1);
    load("uplight");
    const auto light_of = [](int32_t flags) {
        return light_with("models/large.md2", { 0, 0, 90 }, flags, { 60, 0, 0 }, 64);
    };
    const float other = light_of(0);
    EXPECT_GT(other, 1e-3f);
    EXPECT_EQ(light_of(engine::RF_VIEWERMODEL), other);
    EXPECT_EQ(light_of(engine::RF_WEAPONMODEL), 0);
}

// What bounces bring is limited path by path; what lights directly is not.
TEST_F(Optics, MaxRadianceLimitsEachPath)
{
    constexpr float limit = 0.02f;
    load("lit");
    session_->look({ -100, -100, 60 }, { 60, 60, 20 });
    const auto picture = [&](int bounces, double most) {
        session_->set("pt_bounces", bounces);
        session_->set("pt_max_radiance", most);
        session_->draw();
        return session_->capture();
    };
    const Radiance direct = picture(0, 0), all = picture(1, 0), limited = picture(1, double(limit));
    EXPECT_TRUE(picture(1, 1e6) == all);
    EXPECT_TRUE(picture(0, double(limit)) == direct);
    const auto max_between = [&](const Radiance& a) {
        float most = 0;
        for (size_t i = 0; i < a.pixels.size(); i++)
            most = std::max(most, a.pixels[i].y - direct.pixels[i].y);
        return most;
    };
    EXPECT_GT(max_between(all), 5 * limit);
    EXPECT_LT(max_between(limited), 1.1f * limit);
    EXPECT_GT(max_between(limited), 0.5f * limit);
}

// ---- what the game is told

// A lightmap value of 255 under the player is 150; a white floor's radiance of 1 is a lightmap value of 128.
TEST_F(Optics, TheGameLearnsHowBrightTheFloorIs)
{
    load("open");
    session_->look({ 5, 3, 60 }, { 100, 0, 60 });
    const float floor = light_at({ 5, 3, 0 }, 64);
    for (const float scale : { 1.0f, 0.25f }) {
        session_->light_style(0, scale);
        session_->draw(6);
        const engine::Cvar* level = session_->host().cvars().find("r_lightlevel");
        ASSERT_TRUE(level);
        const float wanted = scale * floor * 128 * 150 / 255;
        EXPECT_GT(wanted, 0.1f);
        EXPECT_NEAR(level->number, wanted, 0.03f * wanted);
    }
    session_->light_style(0, 1);
}

// ---- water

constexpr float water_index = 1.33f;
const glm::vec3 water_absorption = 0.5f * glm::vec3(0.035f, 0.013f, 0.012f); // per unit, at pt_water_density 0.5

// Where a ray goes on behind the plane z = 0, as far as it does.
std::optional<CameraRay> refract_at_zero(const CameraRay& ray, float ratio)
{
    const float distance = -ray.origin.z / ray.direction.z;
    if (!(distance > 0))
        return std::nullopt;
    const glm::vec3 normal(0, 0, ray.direction.z < 0 ? 1 : -1);
    const float cosine = -glm::dot(ray.direction, normal), k = 1 - ratio * ratio * (1 - cosine * cosine);
    if (k <= 0.05f)
        return std::nullopt;
    return CameraRay { ray.origin + ray.direction * distance,
        ray.direction * ratio + normal * (ratio * cosine - std::sqrt(k)) };
}

std::optional<bool> is_left_of(const std::optional<CameraRay>& ray, float height, float border)
{
    if (!ray)
        return std::nullopt;
    const glm::vec3 met = ray->origin + ray->direction * ((height - ray->origin.z) / ray->direction.z);
    if (std::abs(met.x - border) < 5 || std::abs(met.x) > 280 || std::abs(met.y) > 280 || std::abs(ray->origin.x) > 280)
        return std::nullopt; // waves sway the border
    return met.x < border;
}

TEST_F(Optics, LooksIntoWaterAreBentTowardsItsFloor)
{
    load("pool_floor");
    session_->look({ -90, 0, 60 }, { 0, 0, -20 }, 60);
    expect_colours(
        session_->accumulate(24),
        [&](const CameraRay& ray) {
            return is_left_of(refract_at_zero(ray, 1 / water_index), pool_floor, floor_border);
        },
        1000);
}

TEST_F(Optics, LooksOutOfWaterAreBentAwayFromItsSurface)
{
    load("pool_ceiling");
    session_->view.flags = engine::RDF_UNDERWATER;
    session_->look({ -40, 0, -60 }, { -15, 0, 0 }, 50);
    expect_colours(
        session_->accumulate(24),
        [&](const CameraRay& ray) {
            return is_left_of(refract_at_zero(ray, water_index), pool_ceiling, ceiling_border);
        },
        1000);
}

TEST_F(Optics, WaterTakesRedFirst)
{
    load("deep");
    const auto seen_from = [&](float distance, int32_t flags) {
        session_->look({ 400 - distance, 0, 0 }, { 400, 0, 0 }, 2);
        session_->view.flags = flags;
        session_->draw();
        return session_->capture().mean();
    };
    for (const float distance : { 40.0f, 300.0f }) {
        const glm::vec3 share = seen_from(distance, engine::RDF_UNDERWATER) / seen_from(distance, 0);
        for (int i = 0; i < 3; i++)
            EXPECT_NEAR(share[i], std::exp(-water_absorption[i] * distance), 0.002f) << distance << ", channel " << i;
    }
}

// ---- pictures on walls

class WallPictures : public Optics {
protected:
    // The floor's colours, seen from above; `width` units across.
    static formats::Image look_down(float width)
    {
        constexpr float fov = 10;
        const float height = width / 2 / std::tan(glm::radians(fov) / 2);
        // A hair off the vertical, so that there is a direction to turn to.
        session_->look({ 0, 0, height }, { 1e-3f, 0, 0 }, fov);
        session_->set("pt_debug_view", "albedo");
        session_->draw();
        return session_->capture_display();
    }
    // Where a pixel looks on the floor.
    static glm::vec3 floor_place(int x, int y)
    {
        const CameraRay ray = camera_ray(session_->view, { x + 0.5f, y + 0.5f });
        return ray.origin - ray.direction * (ray.origin.z / ray.direction.z);
    }
};

// To the right, as the picture's own s axis goes; by 1.6 pictures a second, liquids by half a picture.
TEST_F(WallPictures, FlowingOnesFlow)
{
    constexpr float picture = 16; // units
    load("stripes");
    for (const float time : { 0.0f, 0.1f, 0.2f, 0.55f, 3.3f }) {
        SCOPED_TRACE(time);
        session_->view.time = time;
        const formats::Image seen = look_down(60);
        int told = 0, wrong = 0;
        for (int y = 0; y < seen.height; y++)
            for (int x = 0; x < seen.width; x++) {
                const float u = floor_place(x, y).x / picture - 1.6f * time, part = u - std::floor(u);
                if (std::min({ part, 1 - part, std::abs(part - 0.5f) }) < 0.1f)
                    continue;
                told++;
                wrong += (seen.at(x, y).r > seen.at(x, y).g) != (part < 0.5f);
            }
        EXPECT_GT(told, 1000);
        EXPECT_EQ(wrong, 0);
    }
}

// Texel by texel where a pixel is as large as one, and an even mixture from far away.
TEST_F(WallPictures, AreAsSharpAsThePixelsAre)
{
    load("squares");
    constexpr float texel = 16.0f / picture_texels;
    const auto mean_contrast = [&](float width, float farthest_off) { // from the texels' middles, in texels
        const formats::Image seen = look_down(width);
        double sum = 0;
        int count = 0;
        for (int y = 0; y < seen.height; y++)
            for (int x = 0; x < seen.width; x++) {
                const glm::vec2 at = glm::vec2(floor_place(x, y)) / texel, off = glm::abs(at - glm::floor(at) - 0.5f);
                if (std::max(off.x, off.y) > farthest_off)
                    continue;
                sum += std::abs(int(seen.at(x, y).r) - int(seen.at(x, y).g)) / 255.0;
                count++;
            }
        EXPECT_GT(count, 50);
        return sum / count;
    };
    const float pixels = float(session_->view.width);
    EXPECT_GT(mean_contrast(0.25f * pixels * texel, 0.3f), 0.35);
    EXPECT_GT(mean_contrast(0.97f * pixels * texel, 0.3f), 0.28);
    EXPECT_LT(mean_contrast(8 * pixels * texel, 1), 0.02);
}

} // namespace
} // namespace vkpt::tests
