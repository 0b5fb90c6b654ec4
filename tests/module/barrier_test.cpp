// SPDX-License-Identifier: GPL-2.0-or-later
// Barriers between all work that hands on data, as the rows of the passes tell (pass_rows_test.cpp checks those).
// Passes hand theirs on by buffer addresses: synchronisation validation does not follow them, and a CPU driver runs
// passes in order, barriers or not.
#include "ref_vkpt/frame/pass_rows.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/recording_layer.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

struct Use {
    VkPipelineStageFlags stage;
    VkAccessFlags reads, writes;
};

Use use_of(RecordedCommand::Kind kind)
{
    constexpr VkAccessFlags shader_reads = VK_ACCESS_SHADER_READ_BIT, shader_writes = VK_ACCESS_SHADER_WRITE_BIT;
    switch (kind) {
    case RecordedCommand::dispatch:
        return { VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, shader_reads, shader_writes };
    case RecordedCommand::trace:
        return { VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR, shader_reads, shader_writes };
    case RecordedCommand::build:
        return { VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR, VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR,
            VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR };
    default:
        return { VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_ACCESS_TRANSFER_WRITE_BIT };
    }
}

bool covers(VkFlags mask, VkFlags wanted, VkFlags everything)
{
    return (mask & everything) || (mask & wanted) == wanted;
}

// Whether what `before` wrote can be read, and written anew, by `after`.
bool orders(const RecordedCommand& barrier, const Use& before, const Use& after)
{
    return barrier.global && covers(barrier.from_stages, before.stage, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT)
        && covers(barrier.from_access, before.writes, VK_ACCESS_MEMORY_WRITE_BIT)
        && covers(barrier.to_stages, after.stage, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT)
        && covers(barrier.to_access, after.reads, VK_ACCESS_MEMORY_READ_BIT)
        && covers(barrier.to_access, after.writes, VK_ACCESS_MEMORY_WRITE_BIT);
}

bool is_shader(RecordedCommand::Kind kind)
{
    return kind == RecordedCommand::dispatch || kind == RecordedCommand::trace;
}

const Pass* find_pass(const std::string& name)
{
    const auto pass = std::ranges::find(pass_rows, name, &Pass::name);
    return pass != std::end(pass_rows) ? &*pass : nullptr;
}

// Whether two pieces of work have memory in common that one of them writes.
bool depend(const RecordedCommand& before, const RecordedCommand& after)
{
    const Pass *const first = find_pass(before.label), *const second = find_pass(after.label);
    if (first && second)
        return (first->written_memory & (second->read_memory | second->written_memory))
            || (first->read_memory & second->written_memory);
    if (is_shader(before.kind))
        return after.kind != RecordedCommand::build; // builds read what the host wrote
    // Builds: see StandBetweenTheDevicesOwnTracesToo.
    return is_shader(after.kind) && before.kind != RecordedCommand::build;
}

class Barriers : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", 180);
        folder_->add_wall("lamp", white_index);
        folder_->add_wall("glass", 100);
        cube_path_ = folder_->add_cube("cube", 8, red_index);
        MapBuilder map;
        map.add_lit_room("wall");
        map.add(rectangle({ 40, 0, 40 }, { 0, 30, 0 }, { 0, 0, 30 }), map.add_material("glass", formats::SURF_TRANS33));
        folder_->add_map("room", map.finish());
        setenv("VK_LAYER_PATH", VKPT_RECORDING_LAYER_FOLDER, 1);
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_VKPT_recorder", 1);
        // The layer's path hides the validation layers, which have nothing to say here.
        session_ = std::make_unique<Session>(*folder_, CvarList { { "pt_validation", "0" } }, glm::ivec2(64, 48));
        unsetenv("VK_LAYER_PATH");
        unsetenv("VK_INSTANCE_LAYERS");
        void* layer = dlopen(VKPT_RECORDING_LAYER, RTLD_NOW | RTLD_NOLOAD);
        ASSERT_TRUE(layer) << "the Vulkan loader did not take the layer";
        take_ = reinterpret_cast<TakeRecordedCommands>(dlsym(layer, "vkpt_take_recorded_commands"));
        session_->load_map("room");
        session_->look({ -100, -100, 80 }, { 60, 60, 20 });
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        ASSERT_TRUE(take_);
        for (const auto& [name, value] : CvarList { { "flt_denoiser", "asvgf" }, { "flt_taa", "upscale" },
                 { "pt_bloom", "0.1" }, { "pt_exposure", "0" }, { "pt_count_rays", "0" }, { "pt_trace", "software" } })
            session_->set(name, value);
    }

    // The command buffers of a game's frames: the world with something that moves, a menu's model, 2D before, between
    // and behind.
    static std::vector<RecordedCommands> record_frames(int count)
    {
        std::vector<RecordedCommands> frames;
        take_(frames);
        const engine::Exports8& module = session_->module();
        for (int frame = 0; frame < count; frame++) {
            const engine::Entity cube
                = make_entity(module.register_model(cube_path_.c_str()), { 20, float(frame), 30 });
            engine::RefDef world = session_->view, menu = session_->view;
            world.entities = menu.entities = &cube;
            world.entity_count = menu.entity_count = 1;
            menu.flags = engine::RDF_NOWORLDMODEL;
            menu.width = menu.height = 16;
            module.begin_frame(0);
            module.draw_fill(0, 0, 10, 10, white_index);
            module.render_frame(&world);
            module.draw_fill(8, 8, 10, 10, red_index);
            module.render_frame(&menu);
            module.draw_fade_screen();
            module.end_frame();
        }
        take_(frames);
        return frames;
    }

    // Returns how many shaders ran.
    static size_t expect_ordered(const std::vector<RecordedCommands>& frames)
    {
        size_t shaders = 0;
        for (size_t frame = 0; frame < frames.size(); frame++) {
            const RecordedCommands& commands = frames[frame];
            for (size_t i = 0; i < commands.size(); i++) {
                if (commands[i].kind == RecordedCommand::barrier)
                    continue;
                shaders += is_shader(commands[i].kind);
                if (is_shader(commands[i].kind)) {
                    EXPECT_TRUE(find_pass(commands[i].label)) << "no pass: \"" << commands[i].label << '"';
                }
                expect_ordered_to_next(commands, i, fmt::format("frame {}, command {}", frame, i));
            }
            expect_earlier_frames_are_waited_for(commands);
        }
        return shaders;
    }

private:
    static void expect_ordered_to_next(const RecordedCommands& commands, size_t first, const std::string& place)
    {
        for (size_t i = first + 1; i < commands.size(); i++) {
            if (commands[i].kind == RecordedCommand::barrier || !depend(commands[first], commands[i]))
                continue;
            bool ordered = false;
            for (size_t between = first + 1; between < i; between++)
                ordered |= commands[between].kind == RecordedCommand::barrier
                    && orders(commands[between], use_of(commands[first].kind), use_of(commands[i].kind));
            EXPECT_TRUE(ordered) << place << ": no barrier before the work that follows, command " << i;
            return;
        }
    }
    // The last frame may still run: this one's first shader waits for it.
    static void expect_earlier_frames_are_waited_for(const RecordedCommands& commands)
    {
        bool waits = false;
        for (const RecordedCommand& command : commands) {
            if (command.kind == RecordedCommand::barrier)
                waits |= command.global && (command.from_stages & VK_PIPELINE_STAGE_ALL_COMMANDS_BIT)
                    && (command.from_access & VK_ACCESS_MEMORY_WRITE_BIT);
            else if (is_shader(command.kind)) {
                EXPECT_TRUE(waits) << "the first shader does not wait for the last frame's";
                return;
            }
        }
    }

protected:
    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
    static inline TakeRecordedCommands take_ = nullptr;
    static inline std::string cube_path_;
};

TEST_F(Barriers, StandBetweenAllPassesWithEverySetting)
{
    constexpr int frames = 3; // from the second on with a history
    const auto expect_ordered_frames = [&](size_t min_passes) {
        const auto recorded = record_frames(frames);
        ASSERT_GE(recorded.size(), size_t(frames));
        EXPECT_GE(expect_ordered(recorded), frames * min_passes);
    };
    {
        SCOPED_TRACE("all filters");
        expect_ordered_frames(25);
    }
    for (const auto& [name, value] : CvarList { { "pt_count_rays", "1" }, { "flt_denoiser", "temporal" },
             { "flt_taa", "off" }, { "flt_denoiser", "off" }, { "pt_bloom", "0" } }) {
        SCOPED_TRACE(name + " " + value);
        session_->set(name, value);
        expect_ordered_frames(10);
    }
}

TEST_F(Barriers, StandBetweenTheDevicesOwnTracesToo)
{
    const ModuleInfo info = session_->extension().info();
    for (size_t i = 0; info.trace_backends[i]; i++) {
        const std::string backend = info.trace_backends[i];
        SCOPED_TRACE(backend);
        session_->set("pt_trace", backend);
        const auto recorded = record_frames(2);
        EXPECT_GE(expect_ordered(recorded), 40u);
        // Structures: one barrier from the last build to the shaders that search them.
        for (const RecordedCommands& commands : recorded) {
            bool built = false;
            for (const RecordedCommand& command : commands) {
                if (command.kind == RecordedCommand::build)
                    built = true;
                else if (command.kind == RecordedCommand::barrier)
                    built = built
                        && !(command.global
                            && (command.from_stages & VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR)
                            && (command.from_access & VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR)
                            && (command.to_stages & VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT)
                            && (command.to_access & VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR));
                else if (is_shader(command.kind)) {
                    EXPECT_FALSE(built) << "a shader searches a structure that may still be built";
                }
            }
        }
    }
}

// A pass of one workgroup leaves the device to the next one, where they share nothing.
TEST_F(Barriers, DoNotStandBetweenPassesThatShareNothing)
{
    size_t seen = 0;
    for (const RecordedCommands& commands : record_frames(2))
        for (size_t i = 1; i < commands.size(); i++)
            seen += commands[i].label == "light_level" && commands[i - 1].label == "temporal_antialiasing";
    EXPECT_GE(seen, 2u);
}

// What the host reads after a frame (the light level, counted rays) is made visible to it.
TEST_F(Barriers, MakeResultsVisibleToTheHost)
{
    for (const RecordedCommands& commands : record_frames(2)) {
        size_t barriers = 0;
        for (const RecordedCommand& command : commands)
            barriers += command.kind == RecordedCommand::barrier && command.global
                && (command.from_access & VK_ACCESS_SHADER_WRITE_BIT)
                && (command.to_stages & VK_PIPELINE_STAGE_HOST_BIT) && (command.to_access & VK_ACCESS_HOST_READ_BIT);
        EXPECT_GE(barriers, 2u) << "one for each view";
    }
}

} // namespace
} // namespace vkpt::tests
