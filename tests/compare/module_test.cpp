// SPDX-License-Identifier: GPL-2.0-or-later
// With the real module: the scene that it gives out is the one that it traces and lights, and a whole small comparison.
#include "client/compare/measure.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numbers>

namespace vkpt::tests {
namespace {

using namespace vkpt::client;

// A room with a lamp of its own lightstyle, a point light, and small lamps under the ceiling.
void add_test_map(const GameFolder& folder)
{
    folder.add_wall("wall", 170);
    folder.add_wall("lamp", white_index);
    MapBuilder map;
    map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("wall"));
    const uint16_t lamp = map.add_material("lamp", 0, 300);
    for (int i = 0; i < 12; i++)
        map.add(rectangle({ float(i % 4) * 60 - 90, float(i / 4) * 60 - 60, 120 }, { 0, 8, 0 }, { 8, 0, 0 }), lamp);
    map.add_point_light({ 40, 40, 60 }, 200, 3);
    map.add_entity({ { "classname", "info_player_start" }, { "origin", "-100 -100 32" }, { "angle", "45" } });
    folder.add_map("scene", map.finish());
}

glm::vec3 vector_of(const float (&v)[3]) { return { v[0], v[1], v[2] }; }

double power_from_geometry(const SceneEmitter& emitter)
{
    if (emitter.radius > 0)
        return 4 * std::numbers::pi * std::numbers::pi * double(emitter.radius * emitter.radius)
            * double(emitter.radiance[0]);
    const glm::vec3 a = vector_of(emitter.positions[0]), b = vector_of(emitter.positions[1]),
                    c = vector_of(emitter.positions[2]);
    return std::numbers::pi * 0.5 * double(glm::length(glm::cross(b - a, c - a))) * double(emitter.radiance[0]);
}

class SceneContentsTest : public testing::Test {
protected:
    SceneContentsTest()
    {
        add_test_map(folder_);
        session_ = std::make_unique<Session>(folder_);
        session_->load_map("scene");
        session_->look({ -100, -100, 54 }, { 0, 0, 40 });
        light_ = { { 0, 0, 50 }, { 1, 0.5f, 0.25f }, 200 };
        session_->view.dlights = &light_;
        session_->view.dlight_count = 1;
    }
    SceneContents read()
    {
        session_->draw();
        SceneContents contents {};
        EXPECT_TRUE(session_->extension().read_scene(&contents));
        return contents;
    }
    GameFolder folder_;
    std::unique_ptr<Session> session_;
    engine::DynamicLight light_ {};
};

TEST_F(SceneContentsTest, HasTheEmittersThatPtInfoCounts)
{
    const SceneContents contents = read();
    const ModuleInfo info = session_->extension().info();
    EXPECT_EQ(contents.emitter_count, info.emitters);
    EXPECT_EQ(contents.emitter_count, 12u * 2 + 1 + 1);
    EXPECT_EQ(contents.triangle_count, info.triangles + info.dynamic_triangles);
    double power = 0;
    for (size_t i = 0; i < contents.emitter_count; i++)
        power += power_from_geometry(contents.emitters[i]);
    EXPECT_GT(power, 0);
    EXPECT_NEAR(power, info.emitted_power[0], 1e-4 * power);
    session_->host().run_text("pt_info");
    EXPECT_TRUE(
        session_->has_line(fmt::format("emitters       {}, power {:.6g} ", info.emitters, info.emitted_power[0])));
}

TEST_F(SceneContentsTest, FollowsLightstyles)
{
    SceneContents contents = read();
    const auto find_point_light = [&] {
        for (size_t i = 0; i < contents.emitter_count; i++)
            if (contents.emitters[i].radius > 0 && contents.emitters[i].centre[0] == 40)
                return contents.emitters[i].radiance[0];
        return -1.0f;
    };
    const float whole = find_point_light();
    EXPECT_GT(whole, 0);
    session_->light_style(3, 0.25f);
    contents = read();
    EXPECT_NEAR(find_point_light(), whole / 4, 1e-5f * whole);
}

TEST_F(SceneContentsTest, HasTheTrianglesThatAreTraced)
{
    const SceneContents contents = read();
    std::vector<TracedRay> rays;
    for (size_t i = 0; i < contents.triangle_count; i++) {
        const SceneTriangle& t = contents.triangles[i];
        const glm::vec3 a = vector_of(t.positions[0]), b = vector_of(t.positions[1]), c = vector_of(t.positions[2]);
        const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a)), start = (a + b + c) / 3.0f + normal;
        rays.push_back({ { start.x, start.y, start.z }, 0, { -normal.x, -normal.y, -normal.z }, 10 });
        ASSERT_LT(t.material, contents.material_count);
        if (t.emitter < 0)
            continue;
        ASSERT_LT(size_t(t.emitter), contents.emitter_count);
        const SceneEmitter& emitter = contents.emitters[size_t(t.emitter)];
        for (int channel = 0; channel < 3; channel++) {
            EXPECT_NEAR(contents.materials[t.material].emission[channel], emitter.radiance[channel],
                1e-3f * emitter.radiance[channel]);
            EXPECT_NEAR(t.positions[1][channel], emitter.positions[1][channel], 1e-3f);
        }
    }
    std::vector<TracedHit> hits(rays.size());
    const TraceRequest request;
    ASSERT_GE(session_->extension().trace_rays(rays.data(), rays.size(), &request, hits.data()), 0);
    for (size_t i = 0; i < hits.size(); i++) {
        EXPECT_EQ(hits[i].triangle, i);
        EXPECT_NEAR(hits[i].t, 1, 1e-3f);
        EXPECT_EQ(hits[i].front, 1u);
    }
}

// Each file by a bit.
void damage(const ScratchFolder& references)
{
    const std::vector<std::string> names = references.names();
    ASSERT_EQ(names.size(), 2u); // of whole pixels, and of their centres
    for (const std::string& name : names) {
        std::string text = references.read(name);
        text[text.size() / 2] ^= 1;
        references.write(name, text);
    }
}

TEST(MeasureScene, TellsVariantsApart)
{
    setenv("XDG_CACHE_HOME", VKPT_TEST_CACHE, 1);
    const GameFolder folder;
    add_test_map(folder);
    const ScratchFolder references;
    StageOptions stage_options { { VKPT_TESTED_MODULE, { "pt_bounces=0", "pt_validation=1" }, false },
        folder.path().string(), "", { 64, 64 } };
    MeasureOptions options;
    options.runs = 6;
    options.frames = 3;
    options.warmup = 6;
    options.reference = { 512, "", references.path() };
    const std::vector<Variant> variants { make_variant("uniform"), make_variant("subset", 8),
        make_variant("subset", 8, "asvgf") };
    SceneResult results[2];
    testing::internal::CaptureStderr();
    for (SceneResult& result : results) {
        Stage stage(stage_options, "maps/scene.bsp");
        int last = 0, total = 0;
        result = measure_scene(stage, "maps/scene.bsp", variants, options, [&](int done, int all) {
            EXPECT_GE(done, last);
            last = done;
            total = all;
        });
        EXPECT_EQ(last, total);
    }
    const std::string errors = testing::internal::GetCapturedStderr();
    EXPECT_EQ(errors.find("vkpt validation:"), std::string::npos) << errors;
    EXPECT_FALSE(results[0].reference.was_cached);
    EXPECT_TRUE(results[1].reference.was_cached);
    EXPECT_EQ(results[0].reference.image.rgb, results[1].reference.image.rgb);
    EXPECT_EQ(results[0].reference.rmse, results[1].reference.rmse);

    const std::vector<VariantResult>& measured = results[0].variants;
    const VariantResult &uniform = measured[0], &subset = measured[1], &filtered = measured[2];
    EXPECT_LT(results[0].reference.rmse, 0.2 * subset.error.rmse);
    EXPECT_LT(subset.error.rmse, 0.9 * uniform.error.rmse);
    EXPECT_LT(filtered.error.rmse, 0.8 * subset.error.rmse);
    EXPECT_LT(filtered.flicker, 0.5 * subset.flicker);
    EXPECT_LT(filtered.flip, subset.flip);
    EXPECT_LT(subset.spectrum.low_to_high(), 0.7);
    for (const VariantResult* result : { &uniform, &subset }) {
        EXPECT_LT(std::abs(result->bias.mean), 2 * result->bias.interval);
        EXPECT_LT(result->bias.interval, 0.2);
        EXPECT_GT(result->ms, 0);
        ASSERT_EQ(result->curve.size(), 4u);
        EXPECT_NEAR(result->curve[0].rmse, result->error.rmse, 0.3 * result->error.rmse);
        EXPECT_LT(result->curve[3].rmse, 0.6 * result->curve[0].rmse);
        ASSERT_TRUE(result->equal_time_rmse);
        EXPECT_GE(*result->equal_time_samples, 1);
    }
    EXPECT_FALSE(filtered.equal_time_rmse);

    damage(references);
    Stage stage(stage_options, "maps/scene.bsp");
    EXPECT_FALSE(make_reference(stage, 0, PixelPart::whole, options.reference, [] {}).was_cached);
}

} // namespace
} // namespace vkpt::tests
