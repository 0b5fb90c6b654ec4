// SPDX-License-Identifier: GPL-2.0-or-later
// Calls every slot of every API's table in a module whose renderer tells what reached it.
#include "tests/contract/mock_engine.hpp"

#include <cstring>
#include <dlfcn.h>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

using engine::QBoolean;

// A slot: how to call it with the arguments of its type, and what must reach the renderer.
struct SlotCall {
    const char* expected;
    void (*call)(void (*function)());
};

template <class Signature, class... Arguments> auto call_as(void (*function)(), Arguments... arguments)
{
    return reinterpret_cast<Signature*>(function)(arguments...);
}

constexpr uint8_t pixels[4] = {};
constexpr float axis[3] = { 1, 2, 3 };

const SlotCall init { "call init", [](auto f) { EXPECT_EQ(call_as<QBoolean()>(f), 1); } };
const SlotCall shutdown { "call shutdown", [](auto f) { call_as<void()>(f); } };
const SlotCall prepare { "call prepare_for_window", [](auto f) { EXPECT_EQ(call_as<int()>(f), 0x10000000); } };
const SlotCall context { "call init_context true",
    [](auto f) { EXPECT_EQ((call_as<int(void*)>(f, static_cast<void*>(&f))), 1); } };
const SlotCall drawable { "call get_drawable_size", [](auto f) {
                             int width = 0, height = 0;
                             call_as<void(int*, int*)>(f, &width, &height);
                             EXPECT_EQ(width, 123);
                             EXPECT_EQ(height, 45);
                         } };
const SlotCall shutdown_context { "call shutdown_context", [](auto f) { call_as<void()>(f); } };
const SlotCall vsync { "call is_vsync_active", [](auto f) { EXPECT_EQ(call_as<QBoolean()>(f), 1); } };
const SlotCall begin_registration { "call begin_registration base1",
    [](auto f) { call_as<void(const char*)>(f, "base1"); } };
const SlotCall model { "call register_model a.md2",
    [](auto f) { EXPECT_NE(call_as<void*(const char*)>(f, "a.md2"), nullptr); } };
const SlotCall skin { "call register_skin a.pcx",
    [](auto f) { EXPECT_NE(call_as<void*(const char*)>(f, "a.pcx"), nullptr); } };
const SlotCall sky { "call set_sky unit1_ 0.5 1 2 3",
    [](auto f) { call_as<void(const char*, float, const float*)>(f, "unit1_", 0.5f, axis); } };
const SlotCall end_registration { "call end_registration", [](auto f) { call_as<void()>(f); } };
const SlotCall render { "call render_view 640 480 1 2 3 10 20 0", [](auto f) {
                           engine::RefDef refdef {};
                           refdef.width = 640;
                           refdef.height = 480;
                           for (int i = 0; i < 3; i++)
                               refdef.view_origin[i] = axis[i];
                           refdef.view_angles[0] = 10;
                           refdef.view_angles[1] = 20;
                           call_as<void(const engine::RefDef*)>(f, &refdef);
                       } };
const SlotCall find_pic { "call find_pic ch1",
    [](auto f) { EXPECT_NE(call_as<void*(const char*)>(f, "ch1"), nullptr); } };
const SlotCall pic_size { "call get_pic_size ch1", [](auto f) {
                             int width = 0, height = 0;
                             call_as<void(int*, int*, const char*)>(f, &width, &height, "ch1");
                             EXPECT_EQ(width, 12);
                             EXPECT_EQ(height, 34);
                         } };
const SlotCall pic { "call draw_pic 1 2 ch1 2.5 -1",
    [](auto f) { call_as<void(int, int, const char*, float)>(f, 1, 2, "ch1", 2.5f); } };
const SlotCall stretch { "call draw_stretched_pic 1 2 3 4 ch1",
    [](auto f) { call_as<void(int, int, int, int, const char*)>(f, 1, 2, 3, 4, "ch1"); } };
const SlotCall character { "call draw_character 1 2 65 2.5",
    [](auto f) { call_as<void(int, int, int, float)>(f, 1, 2, 65, 2.5f); } };
const SlotCall tile { "call draw_tiled 1 2 3 4 backtile",
    [](auto f) { call_as<void(int, int, int, int, const char*)>(f, 1, 2, 3, 4, "backtile"); } };
const SlotCall fill { "call draw_fill 1 2 3 4 5",
    [](auto f) { call_as<void(int, int, int, int, int)>(f, 1, 2, 3, 4, 5); } };
const SlotCall fade { "call draw_fade", [](auto f) { call_as<void()>(f); } };
// What lies behind API 5's seven arguments must not be taken for `bits`: the extra argument stands for it.
using RawWithBits = void(int, int, int, int, int, int, const uint8_t*, int);
const SlotCall raw_of_api_5 { "call draw_raw 1 2 3 4 5 6 true 8",
    [](auto f) { call_as<RawWithBits>(f, 1, 2, 3, 4, 5, 6, pixels, 32); } };
const SlotCall raw { "call draw_raw 1 2 3 4 5 6 true 32",
    [](auto f) { call_as<RawWithBits>(f, 1, 2, 3, 4, 5, 6, pixels, 32); } };
const SlotCall palette { "call set_palette true", [](auto f) { call_as<void(const uint8_t*)>(f, pixels); } };
const SlotCall begin_frame { "call begin_frame 0.25", [](auto f) { call_as<void(float)>(f, 0.25f); } };
const SlotCall end_frame { "call end_frame", [](auto f) { call_as<void()>(f); } };
const SlotCall end_world { "call end_world_renderpass", [](auto f) { EXPECT_EQ(call_as<QBoolean()>(f), 1); } };
const SlotCall tinted { "call draw_pic 1 2 ch1 2.5 3",
    [](auto f) { call_as<void(int, int, const char*, float, const float*)>(f, 1, 2, "ch1", 2.5f, axis); } };

std::vector<SlotCall> slots_of(int api)
{
    std::vector<SlotCall> slots { init, shutdown, prepare, context };
    const auto add = [&](std::initializer_list<SlotCall> more) {
        for (const SlotCall& slot : more)
            slots.push_back(slot);
    };
    if (api >= 6)
        add({ drawable });
    add({ shutdown_context, vsync, begin_registration, model, skin, sky, end_registration, render, find_pic, pic_size,
        pic, stretch, character, tile, fill, fade, api >= 6 ? raw : raw_of_api_5, palette, begin_frame, end_frame,
        end_world });
    if (api >= 8)
        add({ tinted });
    return slots;
}

// The largest table, for every API: what a smaller one does not write is not called.
struct Loaded {
    explicit Loaded(const MockEngine& mock)
        : library(dlopen(FAKE_MODULE, RTLD_NOW | RTLD_LOCAL))
    {
        const auto get
            = reinterpret_cast<engine::Exports8 (*)(engine::Imports)>(library ? dlsym(library, "GetRefAPI") : nullptr);
        if (!get)
            throw std::runtime_error(dlerror());
        table = get(mock.imports());
    }
    ~Loaded() { dlclose(library); }
    Loaded(const Loaded&) = delete;
    Loaded& operator=(const Loaded&) = delete;

    void (*function(size_t place) const)()
    {
        void (*pointer)();
        std::memcpy(&pointer, reinterpret_cast<const std::byte*>(&table) + 8 + place * sizeof pointer, sizeof pointer);
        return pointer;
    }

    void* library;
    engine::Exports8 table;
};

class EveryApi : public testing::TestWithParam<std::pair<const char*, int>> { };
INSTANTIATE_TEST_SUITE_P(Releases, EveryApi,
    testing::Values(std::pair("8.20", 5), std::pair("8.30", 6), std::pair("8.50", 7), std::pair("8.70", 8)));

TEST_P(EveryApi, EachSlotReachesItsVerbWithItsArguments)
{
    const auto [version, api] = GetParam();
    MockEngine mock(version);
    const Loaded module(mock);
    ASSERT_EQ(module.table.api, api);
    const std::vector<SlotCall> slots = slots_of(api);
    ASSERT_EQ(8 + slots.size() * sizeof(void*), engine::export_struct_bytes(api));
    for (size_t place = 0; place < slots.size(); place++) {
        SCOPED_TRACE(slots[place].expected);
        mock.console.clear();
        slots[place].call(module.function(place));
        ASSERT_FALSE(mock.console.empty());
        EXPECT_EQ(mock.console[0], slots[place].expected + std::string("\n"));
    }
}

TEST(Exports, MasksTheEnginesBooleans)
{
    MockEngine mock("8.50");
    const Loaded module(mock);
    mock.truth = 0x5a5a5a01;
    mock.falsehood = 0x5a5a5a00;
    EXPECT_EQ(module.table.init(), 1);
    mock.window_works = false;
    EXPECT_EQ(module.table.init(), 0);
}

TEST(Exports, NullNamesAreEmptyNames)
{
    MockEngine mock("8.70");
    const Loaded module(mock);
    module.table.register_model(nullptr);
    EXPECT_EQ(mock.console.back(), "call register_model \n");
}

TEST(Exports, WhatRenderersThrowBecomesTheEnginesErrors)
{
    struct Case {
        const char* thrown;
        int level;
        const char* text;
    };
    constexpr Case cases[] = {
        { "level", engine::ERR_DROP, "the level is over" },
        { "format", engine::ERR_DROP, "maps/x.bsp" },
        { "memory", engine::ERR_DROP, "out of memory in RegisterModel" },
        { "fatal", engine::ERR_FATAL, "the device is lost" },
        { "bug", engine::ERR_FATAL, "internal error in RegisterModel: a bug" },
        { "number", engine::ERR_FATAL, "internal error in RegisterModel" },
    };
    MockEngine mock("8.70");
    const Loaded module(mock);
    // Twice around: a jump must not leave the C++ runtime inside a handler.
    for (int round = 0; round < 2; round++) {
        for (const Case& one : cases) {
            SCOPED_TRACE(one.thrown);
            mock.set("fake_throw", std::string("register_model ") + one.thrown);
            const auto error = catch_error([&] { module.table.register_model("a.md2"); });
            ASSERT_TRUE(error);
            EXPECT_EQ(error->level, one.level);
            EXPECT_NE(error->text.find(one.text), std::string::npos) << error->text;
            EXPECT_EQ(error->text.find('\n'), std::string::npos) << error->text;
        }
    }
    mock.set("fake_throw", "");
    EXPECT_FALSE(catch_error([&] { module.table.register_model("a.md2"); }));
}

TEST(Exports, EveryVerbMayThrow)
{
    MockEngine mock("8.70");
    const Loaded module(mock);
    const std::vector<SlotCall> slots = slots_of(8);
    const auto verb_of = [](const SlotCall& slot) {
        const std::string text = slot.expected + 5;
        return text.substr(0, text.find(' '));
    };
    for (size_t place = 6; place < slots.size(); place++) { // those before answer by their result
        SCOPED_TRACE(slots[place].expected);
        mock.set("fake_throw", verb_of(slots[place]) + " level");
        const auto error = catch_error([&] { slots[place].call(module.function(place)); });
        ASSERT_TRUE(error);
        EXPECT_EQ(error->level, engine::ERR_DROP);
    }
}

// Without a level there is none to drop, and the console would fail for ever.
TEST(Exports, FramesThatFailOverAndOverStopTheEngine)
{
    MockEngine mock("8.70");
    const Loaded module(mock);
    const auto draw = [&] { return catch_error([&] { module.table.begin_frame(0); }); };
    for (int round = 0; round < 3; round++) {
        mock.set("fake_throw", "begin_frame level");
        for (int i = 0; i < 5; i++)
            EXPECT_EQ(draw()->level, engine::ERR_DROP);
        mock.set("fake_throw", "");
        EXPECT_FALSE(draw()) << "a frame that succeeds ends the count";
    }
    mock.set("fake_throw", "begin_frame level");
    int level = engine::ERR_DROP;
    for (int i = 0; i < 20 && level == engine::ERR_DROP; i++)
        level = draw()->level;
    EXPECT_EQ(level, engine::ERR_FATAL);
    mock.set("fake_throw", "");
    EXPECT_FALSE(draw());
}

TEST(Exports, FailureAtStartIsOneLineAndFalse)
{
    for (const char* kind : { "level", "fatal", "format", "memory", "bug", "number" }) {
        SCOPED_TRACE(kind);
        MockEngine mock("8.20");
        const Loaded module(mock);
        mock.set("fake_throw", std::string("init ") + kind);
        EXPECT_FALSE(catch_error([&] { EXPECT_EQ(module.table.init(), 0); }));
        EXPECT_EQ(mock.lines_with("ref_vkpt: ").size(), 1u);
    }
}

TEST(Exports, FailureInTheWindowCallbacksIsTheirResult)
{
    MockEngine mock("8.70");
    const Loaded module(mock);
    mock.set("fake_throw", "prepare_for_window fatal");
    EXPECT_FALSE(catch_error([&] { EXPECT_EQ(module.table.prepare_for_window(), -1); }));
    mock.set("fake_throw", "init_context fatal");
    EXPECT_FALSE(catch_error([&] { EXPECT_EQ(module.table.init_context(nullptr), 0); }));
    mock.set("fake_throw", "shutdown_context bug");
    EXPECT_FALSE(catch_error([&] { module.table.shutdown_context(); }));
    mock.set("fake_throw", "shutdown bug");
    EXPECT_FALSE(catch_error([&] { module.table.shutdown(); }));
    EXPECT_EQ(mock.lines_with("ref_vkpt: ").size(), 4u);
}

TEST(Exports, CommandsReachTheirFunctionAndMayThrow)
{
    MockEngine mock("8.70");
    const Loaded module(mock);
    ASSERT_EQ(module.table.init(), 1);
    ASSERT_TRUE(mock.commands.contains("fake_command"));
    mock.arguments = { "FAKE_command", "seven" };
    mock.commands["fake_command"]();
    EXPECT_EQ(mock.console.back(), "call command seven\n");
    mock.set("fake_throw", "command level");
    const auto error = catch_error([&] { mock.commands["fake_command"](); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->level, engine::ERR_DROP);
}

} // namespace
} // namespace vkpt::tests
