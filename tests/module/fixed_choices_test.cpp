// SPDX-License-Identifier: GPL-2.0-or-later
// GPUs' shaders are compiled for the settings of shared/specialization.h: on a device that calls itself a GPU they draw
// what those draw that read the settings, and frames do not wait for the compiler.
#include "tests/module/faulty_room.hpp"

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <string>

namespace vkpt::tests {
namespace {

class FixedChoices : public FaultyRoom {
protected:
    std::unique_ptr<Session> start() const
    {
        auto session = start_in({ 48, 32 });
        enter(*session);
        return session;
    }
    // Of any pixel, relative to the brighter one. Loops that the compiler drops are rounded otherwise.
    static float largest_difference(const Radiance& a, const Radiance& b)
    {
        float largest = 0;
        for (size_t i = 0; i < a.pixels.size(); i++)
            largest = std::max(largest,
                glm::length(a.pixels[i] - b.pixels[i])
                    / std::max({ glm::length(a.pixels[i]), glm::length(b.pixels[i]), 1e-6f }));
        return largest;
    }
    struct Choices {
        const char *weight, *point, *bounces, *indirect;
    };
    static void choose(Session& session, const Choices& choices)
    {
        session.set("pt_light_weight", choices.weight);
        session.set("pt_light_point", choices.point);
        session.set("pt_bounces", choices.bounces);
        session.set("pt_indirect", choices.indirect);
    }
};

TEST_F(FixedChoices, MakeTheSamePictures)
{
    const Choices choices[] = { { "brdf_centre", "solid_angle", "1", "cache" }, { "ltc", "projected", "2", "both" },
        { "brdf_centre", "area", "1", "trace" } };
    std::vector<Radiance> expected;
    {
        const auto session = start();
        for (const Choices& choice : choices) {
            choose(*session, choice);
            session->draw(2);
            expected.push_back(session->capture());
        }
    }
    Session::end_idle();
    const Faults faults("gpu 256");
    const auto session = start();
    for (size_t i = 0; i < std::size(choices); i++) {
        choose(*session, choices[i]);
        session->draw(2);
        const Radiance picture = session->capture();
        EXPECT_GT(luminance(picture.mean()), 0.01f);
        EXPECT_LT(largest_difference(picture, expected[i]), 1e-5f)
            << choices[i].weight << ", " << choices[i].point << ", bounces " << choices[i].bounces;
        if (i > 0) {
            EXPECT_FALSE(picture == expected[i - 1]) << "the setting does nothing";
        }
    }
}

TEST_F(FixedChoices, ThatChangeDoNotHoldUpTheFrames)
{
    const Faults faults("gpu 256");
    const auto session = this->start();
    session->set("pt_seed", "0"); // a game
    session->draw(4);
    constexpr std::chrono::milliseconds compilation { 3000 };
    faults.set("slow " + std::to_string(compilation.count()));
    choose(*session, { "ltc", "area", "1", "cache" });
    const auto start = std::chrono::steady_clock::now();
    session->draw(3);
    EXPECT_LT(std::chrono::steady_clock::now() - start, compilation) << "frames waited for the compiler";
    session->set("pt_seed", "1"); // pictures that are compared: what is under way is waited for
    session->draw();
    EXPECT_GE(std::chrono::steady_clock::now() - start, compilation);
    EXPECT_GT(luminance(session->capture().mean()), 0.01f);
}

} // namespace
} // namespace vkpt::tests
