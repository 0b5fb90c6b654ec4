// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/cvars.hpp"

#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "tests/contract/mock_engine.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <set>

namespace vkpt::tests {
namespace {

class Cvars : public testing::Test {
protected:
    Cvars()
    {
        engine::attach(mock.imports());
        cvars::register_all();
    }

    MockEngine mock;
};

TEST_F(Cvars, EveryRowIsRegisteredWithItsDefault)
{
    for (const CvarRow& row : cvar_rows) {
        EXPECT_EQ(mock.get(row.name), row.initial) << row.name;
        EXPECT_EQ(bool(mock.cvar_flags[row.name] & engine::CVAR_ARCHIVE),
            row.keep == CvarKeep::archive || row.keep == CvarKeep::user_info)
            << row.name;
        EXPECT_EQ(bool(mock.cvar_flags[row.name] & engine::CVAR_NOSET), row.keep == CvarKeep::start) << row.name;
    }
    EXPECT_EQ(mock.cvar_flags["hand"], engine::CVAR_ARCHIVE | engine::CVAR_USERINFO);
    EXPECT_TRUE(mock.console.empty()) << mock.console.front();
    EXPECT_EQ(cvars::values(), CvarValues());
}

TEST_F(Cvars, RowsAreSound)
{
    std::set<std::string> names;
    for (const CvarRow& row : cvar_rows) {
        SCOPED_TRACE(row.name);
        EXPECT_TRUE(names.insert(row.name).second) << "stands twice";
        EXPECT_TRUE(std::string_view(row.help).ends_with('.'));
        if (row.owner == CvarOwner::engine)
            continue;
        const std::string_view name = row.name;
        EXPECT_TRUE(name.starts_with("pt_") || name.starts_with("flt_")) << "neither the tracer's nor the filters'";
        if (row.type == CvarType::text) {
            EXPECT_TRUE(*row.choices == '\0' || find_choice(row.choices, row.initial) >= 0);
        } else {
            EXPECT_GE(std::stod(row.initial), row.lowest);
            EXPECT_LE(std::stod(row.initial), row.highest);
        }
    }
}

// What no shader reads would be uploaded, and start pictures anew, for nothing.
TEST_F(Cvars, ShadersReadTheirRows)
{
    std::string text;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(VKPT_SHADERS))
        if (const auto ending = entry.path().extension(); ending == ".glsl" || ending == ".comp") {
            std::ifstream file(entry.path());
            text.append(std::istreambuf_iterator<char>(file), {});
        }
#define VKPT_EXPECT_READ(name)                                                                                         \
    EXPECT_NE(text.find("frame.cvars." #name), std::string::npos) << #name " belongs to a HOST row";
#define VKPT_SHADER_INT(name, initial, lowest, highest, keep, help) VKPT_EXPECT_READ(name)
#define VKPT_SHADER_FLOAT(name, initial, lowest, highest, keep, help) VKPT_EXPECT_READ(name)
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help) VKPT_EXPECT_READ(name)
#include "shaders/shared/cvars.def"
#undef VKPT_EXPECT_READ
}

TEST_F(Cvars, SayWhenAChangeCountsWhereItShowsNothingYet)
{
    mock.set("pt_point_light_radius", "8");
    mock.set("pt_device", "paper");
    mock.set("pt_bounces", "3");
    EXPECT_TRUE(cvars::update());
    ASSERT_EQ(mock.console.size(), 2u);
    EXPECT_NE(mock.console[0].find("pt_point_light_radius counts with the next map"), std::string::npos);
    EXPECT_NE(mock.console[1].find("pt_device counts after vid_restart"), std::string::npos);
    EXPECT_FALSE(cvars::update());
    EXPECT_EQ(mock.console.size(), 2u);
}

TEST_F(Cvars, ChangesArriveAtTheNextUpdate)
{
    EXPECT_FALSE(cvars::update());
    mock.set("pt_bounces", "3");
    mock.set("pt_sky_scale", "2.5");
    mock.set("pt_debug_view", "normal");
    mock.set("r_mode", "-2");
    EXPECT_TRUE(cvars::update());
    EXPECT_EQ(cvars::values().pt_bounces, 3);
    EXPECT_EQ(cvars::values().pt_sky_scale, 2.5f);
    EXPECT_EQ(cvars::values().pt_debug_view, "normal");
    EXPECT_EQ(cvars::values().r_mode, -2);
    EXPECT_FALSE(cvars::update());
    EXPECT_TRUE(mock.console.empty()) << mock.console.front();
}

TEST_F(Cvars, ShadersSeeTheNumbers)
{
    mock.set("pt_bounces", "3");
    mock.set("pt_exposure_bias", "-1.5");
    mock.set("pt_debug_view", "roughness");
    mock.set("pt_tone_map", "none");
    cvars::update();
    const shared::ShaderCvars numbers = cvars::shader_values();
    EXPECT_EQ(numbers.pt_bounces, 3);
    EXPECT_EQ(numbers.pt_exposure_bias, -1.5f);
    EXPECT_EQ(numbers.pt_debug_view, shared::DEBUG_VIEW_ROUGHNESS);
    EXPECT_EQ(numbers.pt_tone_map, shared::TONE_MAP_NONE);
}

struct Correction {
    const char* name;
    const char* given;
    const char* used;
};
class CorrectedCvar : public Cvars, public testing::WithParamInterface<Correction> { };
INSTANTIATE_TEST_SUITE_P(Values, CorrectedCvar,
    testing::Values(Correction { "pt_bounces", "99", "8" }, Correction { "pt_bounces", "-1", "0" },
        Correction { "pt_bounces", "2.7", "2" }, Correction { "pt_bounces", "many", "1" },
        Correction { "pt_bounces", "", "1" }, Correction { "pt_bounces", "3x", "1" },
        Correction { "pt_bounces", "1e999", "1" }, Correction { "pt_seed", "99999999999", "16777215" },
        Correction { "pt_exposure_bias", "-9", "-8" }, Correction { "pt_exposure_bias", "nan", "0" },
        Correction { "pt_exposure_bias", "inf", "0" }, Correction { "pt_roughness_default", "0", "0.02" },
        Correction { "pt_trace", "magic", "auto" }, Correction { "pt_tone_map", "", "filmic" }));

TEST_P(CorrectedCvar, IsPutRightWithOneLine)
{
    const auto [name, given, used] = GetParam();
    mock.set(name, given);
    cvars::update();
    EXPECT_EQ(mock.get(name), used);
    ASSERT_EQ(mock.console.size(), 1u);
    EXPECT_NE(mock.console[0].find(name), std::string::npos) << mock.console[0];
    EXPECT_NE(mock.console[0].find(find_cvar_row(name)->initial), std::string::npos) << mock.console[0];
    cvars::update();
    EXPECT_EQ(mock.console.size(), 1u) << "said again: " << mock.console.back();
}

TEST_F(Cvars, ValidSpellingsStay)
{
    for (const char* text : { "2", " 2 ", "+2", "2.0", "2e0" }) {
        mock.set("pt_bounces", text);
        cvars::update();
        EXPECT_EQ(cvars::values().pt_bounces, 2) << text;
        EXPECT_EQ(mock.get("pt_bounces"), text);
    }
    EXPECT_TRUE(mock.console.empty()) << mock.console.front();
}

TEST_F(Cvars, RenamedValuesOfOldConfigurationsStand)
{
    mock.set("pt_light_weight", "chapter");
    cvars::update();
    EXPECT_EQ(cvars::values().pt_light_weight, "brdf_centre");
    EXPECT_EQ(mock.get("pt_light_weight"), "brdf_centre");
    EXPECT_TRUE(mock.console.empty()) << mock.console.front();
}

TEST_F(Cvars, TheEnginesOwnAreNotJudged)
{
    mock.set("r_customwidth", "nonsense");
    mock.set("vid_gamma", "1e30");
    cvars::update();
    EXPECT_EQ(cvars::values().r_customwidth, 0);
    EXPECT_EQ(mock.get("r_customwidth"), "nonsense");
    EXPECT_TRUE(mock.console.empty()) << mock.console.front();
}

TEST_F(Cvars, ValuesOfTheConfigurationCountFromTheStart)
{
    mock.set("pt_light_subset", "17");
    mock.set("pt_render_scale", "10");
    cvars::register_all();
    EXPECT_EQ(cvars::values().pt_light_subset, 17);
    EXPECT_EQ(cvars::values().pt_render_scale, 25);
}

// What a server writes into them by "set NAME VALUE u" comes too late.
TEST_F(Cvars, WhatNamesFilesIsReadAtTheStartOnly)
{
    for (const char* name : { "pt_capture_dir", "pt_capture_mib", "pt_bench_json", "pt_shader_dir" })
        EXPECT_EQ(find_cvar_row(name)->keep, CvarKeep::start) << name;
    mock.set("pt_capture_dir", "mine");
    mock.set("pt_capture_mib", "0");
    cvars::register_all();
    EXPECT_EQ(cvars::values().pt_capture_dir, "mine");
    EXPECT_EQ(cvars::values().pt_capture_mib, 1) << "the range holds";
    EXPECT_EQ(mock.get("pt_capture_mib"), "0") << "the engine refuses to change it, with a line each time";
    mock.set("pt_capture_dir", "theirs");
    mock.set("pt_bench_json", "theirs");
    EXPECT_FALSE(cvars::update());
    EXPECT_EQ(cvars::values().pt_capture_dir, "mine");
    EXPECT_EQ(cvars::values().pt_bench_json, "");
    EXPECT_EQ(mock.console.size(), 1u) << mock.console.back();
}

TEST_F(Cvars, FilesAreGivenBack)
{
    mock.files["a.txt"] = "hello";
    {
        const auto file = engine::load_file("a.txt");
        ASSERT_TRUE(file);
        EXPECT_EQ(file->size(), 5u);
        EXPECT_EQ(char(file->bytes()[4]), 'o');
        EXPECT_EQ(mock.files_out, 1);
        engine::FileData moved = engine::load_file("a.txt").value();
        moved = engine::load_file("a.txt").value();
        EXPECT_EQ(mock.files_out, 2);
    }
    EXPECT_EQ(mock.files_out, 0);
    EXPECT_FALSE(engine::load_file("b.txt"));
    EXPECT_TRUE(engine::file_exists("a.txt"));
    EXPECT_FALSE(engine::file_exists("b.txt"));
}

TEST_F(Cvars, FilesOverTheLimitAreNotAskedFor)
{
    mock.files["maps/small.bsp"] = "tiny";
    constexpr int max_bytes = 256 << 20;
    mock.told_sizes["maps/small.bsp"] = max_bytes;
    EXPECT_TRUE(engine::load_file("maps/small.bsp"));
    EXPECT_EQ(mock.files_loaded, 1);
    mock.told_sizes["maps/small.bsp"] = max_bytes + 1;
    EXPECT_FALSE(engine::load_file("maps/small.bsp"));
    EXPECT_EQ(mock.files_loaded, 1) << "the engine would have taken that memory";
    EXPECT_EQ(mock.lines_with("maps/small.bsp is not read: it has 268435457 bytes").size(), 1u);
}

} // namespace
} // namespace vkpt::tests
