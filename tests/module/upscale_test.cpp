// SPDX-License-Identifier: GPL-2.0-or-later
// Fewer rendered pixels than shown ones: what upscaling brings back, what changes of the size leave alone, and how the
// size follows the time.
#include "ref_vkpt/frame/render_scale.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

class Upscale : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", 180);
        MapBuilder field;
        field.add(rectangle({ 0, 0, 0 }, { 512, 0, 0 }, { 0, 512, 0 }), field.add_material("wall"));
        for (int i = 0; i < 6; i++)
            field.add_block({ 80.0f + 12 * float(i), -60.0f + 20 * float(i), 1 },
                { 84.0f + 12 * float(i), -50.0f + 20 * float(i), 40 }, field.add_material("wall"));
        field.add_point_light({ 0, 0, 3000 }, 100000);
        folder_->add_map("field", field.finish());
        session_ = std::make_unique<Session>(
            *folder_, CvarList { { "pt_bounces", "0" }, { "pt_emission_scale", "0.0001" }, { "pt_seed", "0" } });
        session_->load_map("field");
        session_->look({ 0, -20, 50 }, { 120, 0, 20 });
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    static formats::Image take_reference()
    {
        session_->set("pt_accumulate", 1);
        session_->draw(64);
        session_->set("pt_accumulate", 0);
        return session_->capture_display();
    }
    void SetUp() override
    {
        for (const char* name : { "pt_accumulate", "pt_target_ms" })
            session_->set(name, 0);
        session_->set("pt_render_scale", 100);
        session_->set("flt_taa", "off");
        session_->set("flt_denoiser", "off");
    }

    static formats::Image shown()
    {
        session_->draw();
        return session_->capture_display();
    }

    // What pt_info says of it.
    static std::string rendered() { return session_->info_line("rendered"); }

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
};

double error_between(const formats::Image& a, const formats::Image& b)
{
    double sum = 0;
    for (size_t i = 0; i < a.pixels.size(); i++)
        sum += std::pow(double(a.pixels[i].g) - double(b.pixels[i].g), 2);
    return sum / double(a.pixels.size());
}

TEST_F(Upscale, QuarterOfThePixelsComesNearTheWholePicture)
{
    const formats::Image reference = take_reference();
    session_->set("pt_render_scale", 50);
    session_->set("flt_taa", "on");
    session_->draw(40);
    const double enlarged = error_between(session_->capture_display(), reference);
    session_->set("flt_taa", "upscale");
    session_->draw(60);
    const double upscaled = error_between(session_->capture_display(), reference);
    EXPECT_GT(enlarged, 0);
    EXPECT_LT(upscaled, 0.7 * enlarged);
    const Radiance picture = session_->capture(); // as many pixels as the window
    EXPECT_EQ(count_broken(picture), 0u);
}

// What enlarging has left soft gains contrast, and what is even stays as it is.
TEST_F(Upscale, SharpeningComesNearerTheWholePicture)
{
    const formats::Image reference = take_reference();
    session_->set("pt_render_scale", 50);
    session_->set("flt_taa", "on");
    session_->draw(60);
    const formats::Image soft = session_->capture_display();
    session_->set("flt_sharpen", 1);
    session_->draw(8);
    const formats::Image sharp = session_->capture_display();
    session_->set("flt_sharpen", 0);
    RecordProperty("soft", std::to_string(error_between(soft, reference)));
    RecordProperty("sharp", std::to_string(error_between(sharp, reference)));
    EXPECT_LT(error_between(sharp, reference), 0.9 * error_between(soft, reference));
    for (int x = 0; x < 8; x++)
        EXPECT_NEAR(sharp.at(x, 46).g, soft.at(x, 46).g, 3); // the ground in the lower corner
}

// A picture in another render size goes on from the one before: it is nearer to it than one that begins anew.
TEST_F(Upscale, AChangeOfSizeKeepsTheHistory)
{
    session_->set("flt_taa", "upscale");
    session_->set("flt_denoiser", "asvgf");
    for (const int scale : { 75, 50 }) {
        session_->set("pt_render_scale", 100);
        session_->draw(40);
        const formats::Image before = shown();
        session_->set("pt_render_scale", scale);
        const double kept = error_between(before, shown());
        session_->draw(20);
        session_->set("pt_render_scale", 100);
        const double kept_upwards = error_between(before, shown());
        session_->set("pt_render_scale", scale);
        session_->load_map("field");
        const double anew = error_between(before, shown());
        session_->set("pt_render_scale", 100);
        session_->load_map("field");
        const double anew_upwards = error_between(before, shown());
        EXPECT_LT(kept, 0.5 * anew) << scale;
        EXPECT_LT(kept_upwards, 0.8 * anew_upwards) << scale;
    }
}

// With a time that no frame can keep, and one that all do.
TEST_F(Upscale, TheSizeFollowsTheTime)
{
    session_->set("flt_taa", "upscale");
    session_->draw();
    EXPECT_NE(rendered().find("64 x 48"), std::string::npos) << rendered();
    session_->set("pt_target_ms", 0.001);
    session_->draw(12);
    EXPECT_NE(rendered().find("32 x 24"), std::string::npos) << rendered();
    session_->set("pt_target_ms", 1000);
    session_->draw(24);
    EXPECT_NE(rendered().find("64 x 48"), std::string::npos) << rendered();
    EXPECT_NE(rendered().find(" 0 non-finite"), std::string::npos) << rendered();
}

// Questions about a frame read its time again, and frames without a view of the world are fast for other reasons.
TEST_F(Upscale, EachViewOfTheWorldCountsOnce)
{
    session_->set("flt_taa", "upscale");
    session_->draw(8);
    session_->set("pt_target_ms", 0.001);
    session_->draw(); // with all that comes four frames' times count, of the five that a change takes
    InspectedSurface surface {};
    for (int i = 0; i < 20; i++)
        ASSERT_TRUE(session_->extension().inspect_pixel(32, 40, &surface, nullptr, 0));
    session_->draw();
    EXPECT_NE(rendered().find("64 x 48"), std::string::npos) << rendered() << " after questions";
    for (int i = 0; i < 20; i++) {
        session_->module().begin_frame(0);
        session_->module().end_frame();
    }
    const engine::RefDef world = session_->view;
    session_->view.flags = engine::RDF_NOWORLDMODEL;
    session_->draw(20);
    session_->view = world;
    session_->draw();
    EXPECT_NE(rendered().find("64 x 48"), std::string::npos) << rendered() << " after menus";
}

// A device whose frames take `fixed` ms and `full` ms for all pixels.
double run_device(
    RenderScale& scale, const RenderScale::Limits& limits, double fixed, double full, int frames, int& changes)
{
    double milliseconds = 0;
    for (int i = 0; i < frames; i++) {
        const double share = scale.percent(limits) / 100.0;
        milliseconds = fixed + full * share * share + (i % 7 == 0 ? 40 : 0); // now and then a slow one
        const uint32_t before = scale.percent(limits);
        scale.add_frame(milliseconds, limits);
        changes += scale.percent(limits) != before;
        milliseconds = fixed + full * share * share;
    }
    return milliseconds;
}

TEST(RenderScale, HoldsTheTargetWithoutSwinging)
{
    for (const double full : { 20.0, 60.0, 90.0, 110.0 }) {
        RenderScale scale;
        const RenderScale::Limits limits { 40, 50, 100 };
        int changes = 0;
        run_device(scale, limits, 5, full, 100, changes);
        changes = 0;
        const double last = run_device(scale, limits, 5, full, 100, changes);
        EXPECT_EQ(changes, 0) << full;
        EXPECT_LE(last, 1.04 * 40) << full;
        const uint32_t percent = scale.percent(limits);
        const double larger = (percent + 2 * RenderScale::step) / 100.0;
        EXPECT_TRUE(percent == 100 || 5 + full * larger * larger > 0.93 * 40)
            << full << ": " << percent; // not needlessly small
    }
}

TEST(RenderScale, KeepsItsLimits)
{
    RenderScale scale;
    int changes = 0;
    run_device(scale, { 10, 50, 90 }, 0, 1000, 50, changes);
    EXPECT_EQ(scale.percent({ 10, 50, 90 }), 50u);
    EXPECT_EQ(scale.percent({ 0, 50, 90 }), 90u);
    EXPECT_EQ(scale.percent({ 10, 50, 30 }), 30u); // the player's wish is the upper limit
}

} // namespace
} // namespace vkpt::tests
