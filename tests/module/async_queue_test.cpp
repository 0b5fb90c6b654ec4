// SPDX-License-Identifier: GPL-2.0-or-later
// A device with a second queue for compute: what a frame's shaders need is built and copied there while the first queue
// still has the last frame, and the pictures stay the same.
#include "tests/module/faulty_room.hpp"

namespace vkpt::tests {
namespace {

struct AsyncWork {
    const char* name;
    const char* faults; // of the device
    CvarList settings;
};

class AsyncQueue : public FaultyRoom, public testing::WithParamInterface<AsyncWork> {
protected:
    std::unique_ptr<Session> start() const
    {
        auto session = std::make_unique<Session>(folder_, GetParam().settings, glm::ivec2(67, 45));
        enter(*session);
        return session;
    }

    // A cube that moves through the room, frame after frame.
    void draw(Session& session, int frames) const
    {
        engine::Entity cube = make_cube(session, { -20, -20, 20 });
        session.view.entities = &cube;
        session.view.entity_count = 1;
        for (int i = 0; i < frames; i++) {
            cube.origin[0] = -20.0f + 5.0f * float(i);
            session.draw();
        }
        session.view.entity_count = 0;
    }
};

constexpr int frames = 9;

TEST_P(AsyncQueue, WorksBesideTheLastFrame)
{
    Radiance expected;
    {
        const auto session = start();
        draw(*session, frames);
        expected = session->capture();
    }
    Session::end_idle();
    const Faults faults(std::string("async\n") + GetParam().faults);
    {
        const auto session = start();
        draw(*session, frames);
        const FaultCounts counts = Faults::counts();
        EXPECT_EQ(counts.async_submissions, uint32_t(frames));
        EXPECT_EQ(counts.frames_after_async, uint32_t(frames)) << "a frame's shaders wait for what they need";
        EXPECT_EQ(counts.async_beside_a_frame, uint32_t(frames - 1)) << "and nothing else waits";
        EXPECT_TRUE(session->capture() == expected);

        session->set("pt_async", 0);
        draw(*session, frames);
        EXPECT_EQ(Faults::counts().async_submissions, uint32_t(frames));
        EXPECT_TRUE(session->capture() == expected);
    }
    Session::end_idle();
}

const CvarList by_query { { "pt_trace", "query" }, { "pt_bounces", "2" } },
    by_software { { "pt_trace", "software" }, { "pt_device_rays", "0" }, { "pt_bounces", "2" } };
INSTANTIATE_TEST_SUITE_P(Of, AsyncQueue,
    testing::Values(AsyncWork { "Structures", "", by_query }, AsyncWork { "Uploads", "gpu 256", by_software }),
    [](const testing::TestParamInfo<AsyncWork>& info) { return info.param.name; });

// Nothing for the device to do ahead: the CPU builds the trees where the device reads them.
using UnusedAsyncQueue = FaultyRoom;
TEST_F(UnusedAsyncQueue, GetsNothingWhereTheCpuDoesAll)
{
    const Faults faults("async");
    {
        const auto session = start_in({ 67, 45 });
        enter(*session);
        session->draw(3);
        EXPECT_EQ(Faults::counts().async_submissions, 0u);
    }
    Session::end_idle();
}

} // namespace
} // namespace vkpt::tests
