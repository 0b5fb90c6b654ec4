// SPDX-License-Identifier: GPL-2.0-or-later
// Every light sampler that the module lists converges to the same picture.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr int runs = 32, frames_per_run = 16, region = 16;

// Means over many independent runs, for each region of the picture.
struct Estimate {
    std::vector<double> mean, variance_of_mean;
};

class Samplers : public testing::Test {
protected:
    Samplers()
    {
        for (const auto& [name, index] : { std::pair { "wall", uint8_t(170) }, std::pair { "red", red_index },
                 std::pair { "green", green_index }, std::pair { "blue", blue_index } })
            folder_.add_wall(name, index);
        MapBuilder map;
        const uint16_t wall = map.add_material("wall");
        map.add_room({ -256, -256, 0 }, { 256, 256, 160 }, wall);
        map.add_block({ -40, -40, 0 }, { 10, 30, 120 }, wall);
        const uint16_t lamps[] = { map.add_material("red", 0, 400), map.add_material("green", 0, 1500),
            map.add_material("blue", 0, 5000) };
        for (int i = 0; i < 12; i++) {
            const float x = float(i % 4) * 120 - 180, y = float(i / 4) * 150 - 150, size = 4 + float(i * 7 % 20);
            map.add(rectangle({ x, y, 150 }, { 0, size, 0 }, { size, 0, 0 }), lamps[i % 3]);
        }
        map.add(rectangle({ 255, 0, 60 }, { 0, 0, 20 }, { 0, 60, 0 }), lamps[1]); // faces -x
        map.add_point_light({ -200, 200, 40 }, 120);
        folder_.add_map("lights", map.finish());
        // The light cache has tables and samples of its own.
        session_ = std::make_unique<Session>(
            folder_, CvarList { { "pt_accumulate", "1" }, { "pt_light_subset", "4" }, { "pt_indirect", "trace" } });
        session_->load_map("lights");
        session_->look({ -220, -220, 120 }, { 60, 60, 20 });
        session_->view.dlights = &shot_;
        session_->view.dlight_count = 1;
    }

    Estimate estimate(const std::string& sampler)
    {
        session_->set("pt_light_sampler", sampler);
        Estimate result;
        std::vector<double> sum, sum_of_squares;
        for (int run = 1; run <= runs; run++) {
            session_->set("pt_seed", run);
            session_->draw(frames_per_run);
            EXPECT_EQ(session_->extension().accumulated_frames(), uint32_t(frames_per_run));
            const Radiance picture = session_->capture();
            size_t at = 0;
            for (int y = 0; y < picture.height; y += region)
                for (int x = 0; x < picture.width; x += region, at++) {
                    const double value = luminance(picture.mean({ x, y }, { x + region, y + region }));
                    sum.resize(std::max(sum.size(), at + 1));
                    sum_of_squares.resize(sum.size());
                    sum[at] += value;
                    sum_of_squares[at] += value * value;
                }
        }
        for (size_t i = 0; i < sum.size(); i++) {
            const double mean = sum[i] / runs, variance = (sum_of_squares[i] / runs - mean * mean) * runs / (runs - 1);
            result.mean.push_back(mean);
            result.variance_of_mean.push_back(variance / runs);
        }
        return result;
    }

    const engine::DynamicLight shot_ { { 120, 120, 60 }, { 1, 0.7f, 0.2f }, 250 };
    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

TEST_F(Samplers, AgreeWithinFourSigma)
{
    const std::vector<std::string> names = unbiased_samplers(session_->extension().info());
    ASSERT_GE(names.size(), 2u);
    const Estimate reference = estimate("uniform");
    for (const std::string& name : names) {
        if (name == "uniform")
            continue;
        const Estimate other = estimate(name);
        ASSERT_EQ(other.mean.size(), reference.mean.size());
        for (size_t i = 0; i < reference.mean.size(); i++) {
            EXPECT_GT(reference.mean[i], 0);
            const double sigma = std::sqrt(reference.variance_of_mean[i] + other.variance_of_mean[i]);
            EXPECT_LT(std::abs(other.mean[i] - reference.mean[i]), 4 * sigma)
                << name << " " << other.mean[i] << ", uniform " << reference.mean[i] << ", region " << i;
            // Else four sigma would say nothing.
            EXPECT_LT(sigma, 0.03 * reference.mean[i]) << name << ", region " << i;
        }
    }
}

// Multisets and trees take memory, and time to make: only samplers that read them bring them to the device.
TEST_F(Samplers, TablesComeWithTheFirstSamplerThatReadsThem)
{
    const auto draw = [&](const char* sampler) {
        session_->set("pt_light_sampler", sampler);
        session_->draw(2);
        return session_->capture().pixels;
    };
    const auto light_bytes = [&] { return session_->extension().info().light_bytes; };
    session_->set("pt_light_sampler", "uniform");
    session_->load_map("lights");
    draw("uniform");
    const uint64_t lists_alone = light_bytes();
    const auto by_tree = draw("light_tree");
    const uint64_t with_trees = light_bytes();
    EXPECT_GT(with_trees, lists_alone);
    const auto by_multiset = draw("subset_pps");
    EXPECT_GT(light_bytes(), with_trees);
    // The same pictures as with tables that were there from the start.
    session_->load_map("lights");
    EXPECT_EQ(draw("subset_pps"), by_multiset);
    session_->set("pt_light_sampler", "light_tree");
    session_->load_map("lights");
    EXPECT_EQ(draw("light_tree"), by_tree);
}

// A player who changes the sampler sees frames go on.
TEST_F(Samplers, FramesGoOnUntilTheTablesAreThere)
{
    session_->set("pt_accumulate", "0");
    session_->set("pt_seed", "0");
    session_->set("pt_light_sampler", "uniform");
    session_->load_map("lights");
    session_->draw();
    const uint64_t lists_alone = session_->extension().info().light_bytes;
    session_->set("pt_light_sampler", "light_tree");
    int frames = 0;
    for (; frames < 500 && session_->extension().info().light_bytes == lists_alone; frames++) {
        session_->draw();
        EXPECT_FALSE(is_black(session_->capture()));
    }
    EXPECT_LT(frames, 500);
}

TEST_F(Samplers, AnUnknownNameIsToldAndReplaced)
{
    session_->set("pt_light_sampler", "no_such_sampler");
    session_->draw();
    EXPECT_TRUE(session_->has_line("there is no pt_light_sampler \"no_such_sampler\""));
    EXPECT_STREQ(session_->host().cvars().get("pt_light_sampler", "", 0)->text, "subset_pps");
    EXPECT_FALSE(is_black(session_->capture()));
    session_->set("pt_light_sampler", "nor_such_a_one");
    session_->load_map("lights"); // which reads the settings, too
    session_->draw();
    EXPECT_TRUE(session_->has_line("there is no pt_light_sampler \"nor_such_a_one\""));
}

TEST(SamplerAtTheStart, AnUnknownNameIsToldAndReplaced)
{
    Session::end_idle();
    const GameFolder folder;
    Session session(folder, { { "pt_light_sampler", "no_such_sampler" } });
    EXPECT_TRUE(session.has_line("there is no pt_light_sampler \"no_such_sampler\""));
    EXPECT_STREQ(session.host().cvars().get("pt_light_sampler", "", 0)->text, "subset_pps");
}

} // namespace
} // namespace vkpt::tests
