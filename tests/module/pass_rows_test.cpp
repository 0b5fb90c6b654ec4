// SPDX-License-Identifier: GPL-2.0-or-later
// The rows of shaders/passes.def against the shaders: what a pass loads and stores is what its row says, or the
// barriers that come from it are wrong, which no CPU driver would show.
#include "ref_vkpt/frame/pass_rows.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace vkpt::tests {
namespace {

// SPIR-V with names, of the build for the software backend and a sampler with MIS. A function that is never called is
// left out by the compiler, and with it its name.
std::string compile_with_names(const Pass& pass)
{
    const std::string file = fmt::format("{}{}.spv", testing::TempDir(), pass.name);
    std::string source;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(VKPT_SHADERS))
        if (entry.path().filename() == fmt::format("{}.comp", pass.name))
            source = entry.path().string();
    const std::string command = fmt::format("{0} --quiet -V -g --target-env vulkan1.2 -I{1} -I{2}/selected/subset_mis "
                                            "-DVKPT_TRACE_SOFTWARE -DVKPT_SAMPLER_MIS {4} -o {3} {5}",
        VKPT_GLSLANG, VKPT_SHADERS, VKPT_BUILT_SHADERS, file, fmt::format("-DVKPT_PUSH={}", pass.push), source);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream stream(file, std::ios::binary);
    const std::string code { std::istreambuf_iterator<char>(stream), {} };
    std::filesystem::remove(file);
    return code;
}

// Names of functions, with what follows their "(".
std::set<std::string> find_names(const std::string& code)
{
    constexpr size_t header_words = 5;
    constexpr uint32_t op_name = 5;
    std::vector<uint32_t> words(code.size() / sizeof(uint32_t));
    std::memcpy(words.data(), code.data(), words.size() * sizeof(uint32_t));
    std::set<std::string> names;
    for (size_t at = header_words; at < words.size(); at += std::max(words[at] >> 16, 1u))
        if ((words[at] & 0xffff) == op_name)
            names.insert(code.c_str() + (at + 2) * sizeof(uint32_t)); // ends with 0
    return names;
}

// By functions load_NAME or store_NAME.
PassResources find_calls(const std::set<std::string>& names, const std::string& verb)
{
    PassResources found = 0;
    for (uint32_t i = 0; i < shared::SCREEN_BUFFER_COUNT; i++) {
        const std::string call = fmt::format("{}_{}(", verb, pass_resource_names[i]);
        if (const auto name = names.lower_bound(call); name != names.end() && name->starts_with(call))
            found |= PassResources(1) << i;
    }
    return found;
}

std::string name_all(PassResources resources)
{
    std::string names;
    for (uint32_t i = 0; i < resource_count; i++)
        if (resources >> i & 1)
            names += fmt::format(" {}", pass_resource_names[i]);
    return names;
}

// What has no load_ and store_ of its own: reached by an address.
constexpr PassResources by_address = find_resources("bloom image exposure light_cache light_visibility trace_stack");

TEST(PassRows, SayWhatTheShadersLoadAndStore)
{
    for (const Pass& pass : pass_rows) {
        SCOPED_TRACE(pass.name);
        const std::string code = compile_with_names(pass);
        ASSERT_FALSE(code.empty());
        const PassResources loads = find_calls(find_names(code), "load"),
                            stores = find_calls(find_names(code), "store");
        EXPECT_EQ(name_all(loads & ~pass.reads), "") << "loaded, and missing from the row";
        EXPECT_EQ(name_all(stores & ~pass.writes), "") << "stored, and missing from the row";
        if (pass.push_bytes > 0)
            continue; // it is told which further buffers
        EXPECT_EQ(name_all(pass.reads & ~loads & ~by_address), "") << "in the row, and not loaded";
        EXPECT_EQ(name_all(pass.writes & ~stores & ~by_address), "") << "in the row, and not stored";
    }
}

// Every buffer that is read is written by a pass of the same view, or by one of the last.
TEST(PassRows, ReadNothingThatNobodyWrites)
{
    PassResources reads = 0;
    std::set<std::string, std::less<>> written;
    for (const Pass& pass : pass_rows) {
        reads |= pass.reads;
        for (uint32_t i = 0; i < resource_count; i++)
            if (pass.writes >> i & 1)
                written.insert(
                    { std::string(pass_resource_names[i]), fmt::format("previous_{}", pass_resource_names[i]) });
    }
    for (uint32_t i = 0; i < resource_count; i++)
        if (reads >> i & 1) {
            EXPECT_TRUE(written.contains(pass_resource_names[i])) << pass_resource_names[i];
        }
}

// The passes from the first that uses one of these to the last.
struct Use {
    size_t first = std::size(pass_rows), last = 0;
};
Use find_use(PassResources resources)
{
    Use use;
    for (size_t i = 0; i < std::size(pass_rows); i++)
        if ((pass_rows[i].reads | pass_rows[i].writes) & resources) {
            use.first = std::min(use.first, i);
            use.last = i;
        }
    return use;
}

bool reads_after(size_t pass, PassResources resources)
{
    for (size_t i = pass + 1; i < std::size(pass_rows); i++)
        if (pass_rows[i].writes & resources)
            return false;
        else if (pass_rows[i].reads & resources)
            return true;
    return false;
}

// What is stored in memory that belongs to another buffer is read before that is stored again, and nobody reads the
// other in its place: neither in this view, nor, if it has a history, in the next one.
TEST(PassRows, LendMemoryThatIsFree)
{
    std::vector<std::pair<PassResource, Use>> uses;
    for (const BorrowedBuffer& borrowed : borrowed_buffers) {
        SCOPED_TRACE(pass_resource_names[borrowed.name]);
        const PassResources lender = PassResources(1) << borrowed.lender;
        const Use use = find_use(PassResources(1) << borrowed.name);
        ASSERT_LE(use.first, use.last);
        EXPECT_TRUE(pass_rows[use.first].writes >> borrowed.name & 1) << "read before it is stored";
        for (size_t i = use.first; i <= use.last; i++)
            EXPECT_FALSE((pass_rows[i].reads | pass_rows[i].writes) & lender) << pass_rows[i].name;
        EXPECT_FALSE(reads_after(use.last, lender)) << "of its lender";
        const std::string name(pass_resource_names[borrowed.lender]);
        const bool has_history
            = std::ranges::find(pass_resource_names, "previous_" + name) != std::end(pass_resource_names);
        if (has_history) {
            EXPECT_LT(use.last, find_use(lender).first) << "stored over what the next view reads";
        } else {
            EXPECT_TRUE(name.starts_with("previous_")) << "its lender is of this view alone";
        }
        for (const auto& [other, other_use] : uses)
            if (other == borrowed.lender) {
                EXPECT_TRUE(use.last < other_use.first || other_use.last < use.first) << "two at once";
            }
        uses.emplace_back(borrowed.lender, use);
    }
    EXPECT_FALSE(uses.empty());
}

// The list's order is the frame's: a view starts with its surfaces and ends with what is shown.
TEST(PassRows, BeginWithTheCameraAndEndWithThePicture)
{
    EXPECT_EQ(pass_rows[0].id, PassId::primary_visibility);
    const Pass* last = nullptr;
    for (const Pass& pass : pass_rows)
        if (pass.is_run_with(0))
            last = &pass;
    ASSERT_TRUE(last);
    EXPECT_EQ(last->id, PassId::tone_map);
    EXPECT_FALSE(find_pass(PassId::exposure).is_run_with(shared::FRAME_PROBES));
    EXPECT_FALSE(find_pass(PassId::replay_samples).is_run_with(shared::FRAME_REPLAYED));
    EXPECT_TRUE(find_pass(PassId::replay_samples).is_run_with(shared::FRAME_REPLAYED | shared::FRAME_HISTORY));
}

} // namespace
} // namespace vkpt::tests
