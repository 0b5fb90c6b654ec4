// SPDX-License-Identifier: GPL-2.0-or-later
// The module on a device that calls itself a GPU with memory of its own, little or none of which the CPU sees: the same
// pictures, whatever has to be copied and however lanes keep their arrays, and a message where nothing fits.
#include "tests/module/faulty_room.hpp"

namespace vkpt::tests {
namespace {

class GpuMemory : public FaultyRoom {
protected:
    std::unique_ptr<Session> start() const
    {
        // With one bounce the GPU's shaders have no loop, and round otherwise (FixedChoices). Tiles of 8 x 8 pixels
        // overlap the edges.
        return start_in({ 67, 45 }, { { "pt_bounces", "2" } });
    }

    // Things come and go, the map starts anew.
    std::vector<Radiance> draw_all(Session& session) const
    {
        std::vector<Radiance> pictures;
        for (int round = 0; round < 2; round++) {
            enter(session);
            const engine::Entity cube = make_cube(session, { 20, -20, 20 });
            for (int frame = 0; frame < 6; frame++) {
                session.view.entities = &cube;
                session.view.entity_count = frame % 3 != 2;
                session.draw();
                pictures.push_back(session.capture());
            }
        }
        return pictures;
    }

    void expect_same(const std::vector<Radiance>& pictures, const std::vector<Radiance>& expected) const
    {
        ASSERT_EQ(pictures.size(), expected.size());
        for (size_t i = 0; i < pictures.size(); i++) {
            EXPECT_GT(luminance(pictures[i].mean()), 0.01f);
            EXPECT_TRUE(pictures[i] == expected[i]) << "picture " << i;
        }
    }
};

TEST_F(GpuMemory, OfWhichTheCpuSeesLittleHoldsTheSame)
{
    const std::vector<Radiance> expected = draw_all(*start());
    Session::end_idle();
    for (const char* gpu : { "gpu 256", "gpu 2", "gpu 0" }) {
        SCOPED_TRACE(gpu);
        const Faults faults(gpu);
        {
            const auto session = start();
            expect_same(draw_all(*session), expected);
            const FaultCounts counts = Faults::counts();
            EXPECT_GT(counts.hidden_bytes, 0u);
            EXPECT_EQ(counts.refused_allocations > 0, std::string(gpu) != "gpu 256");
        }
        Session::end_idle();
    }
}

TEST_F(GpuMemory, ThatIsFullDropsTheLevelAndSaysWhatHelps)
{
    MapBuilder map;
    const uint16_t wall = map.add_material("wall");
    for (int i = 0; i < 200'000; i++) // more than lies about in blocks
        map.add(rectangle({ i % 500, i / 500, 0 }, { 1, 0, 0 }, { 0, 1, 0 }), wall);
    formats::Bsp large = map.finish();
    large.format = formats::BspFormat::qbsp; // more faces than IBSP has numbers for
    folder_.add_map("large", large);
    const Faults faults("gpu 256");
    const auto session = start();
    faults.set("memory 0");
    try {
        session->load_map("large");
        session->draw();
        ADD_FAILURE() << "it did fit";
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("pt_render_scale"), std::string::npos) << error.what();
    }
    faults.set("");
    session->load_map("room");
    session->draw(2);
    EXPECT_GT(luminance(session->capture().mean()), 0.01f);
}

TEST_F(GpuMemory, OfALostDeviceTellsThePass)
{
    const Faults faults("gpu 256");
    const auto session = start();
    enter(*session);
    session->draw(3);
    faults.set("lost");
    session->draw(2);
    EXPECT_TRUE(session->has_line("in the pass tone_map of frame"));
    EXPECT_TRUE(session->has_line("maps/room.bsp"));
    EXPECT_TRUE(session->has_line("starting the renderer anew"));
}

} // namespace
} // namespace vkpt::tests
